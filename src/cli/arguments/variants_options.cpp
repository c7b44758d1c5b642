#include "cli/arguments/options.h"
#include "variants/plan.h"

namespace tuft::cli {

CLI::App* add_variants(CLI::App& app, VariantsWork& work) {
    auto* s = app.add_subcommand("variants", "paint many variants of a decoration, here or on a scheduler");
    allow_shipped(
        s->add_option("PLAN", work.plan,
                      "plan (.toml): models x stroke files x inks x brushes x tolerances; or the folder of its tasks"))
        ->required();
    s->add_option("-o,--output", work.output, "folder of the tasks and results of a plan");
    s->add_flag("--run", work.run,
                "paint what is not done yet by worker processes, one per core or --threads; then as --gather");
    s->add_flag("--gather", work.gather,
                "write table.csv, table.json, contact sheets, and a tolerance map of each decoration");
    return s;
}

CLI::App* add_run_task(CLI::App& app, RunTask& work) {
    auto* s = app.add_subcommand("run-task", "paint one variant of 'tuft variants', as schedulers do");
    s->add_option("FOLDER", work.folder, "folder of the tasks")->required();
    auto* index = s->add_option("INDEX", work.index, "number of the task, from 0")
                      ->check(number_in(0, static_cast<double>(variants::kMostTasks)));
    s->add_option("--count", work.count, "so many tasks from there on")
        ->check(number_in(1, static_cast<double>(variants::kMostTasks)))
        ->needs(index);
    s->add_flag("--rest", work.rest, "all tasks that are not done and that no other process has; says which")
        ->excludes(index);
    return s;
}

}  // namespace tuft::cli
