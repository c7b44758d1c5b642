#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/commands/paint.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/system/memory.h"
#include "core/system/parallel.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "variants/deviation.h"
#include "variants/gather.h"
#include "variants/scripts.h"
#include "variants/tolerance_maps.h"
#include "variants/workers.h"

/// `tuft variants` and `tuft run-task`: many variants of a decoration.
namespace tuft::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Paints tasks as `tuft paint` does. Keeps the model of the last one.
class TaskPainter {
  public:
    TaskPainter(fs::path plan_folder, Console& console) : folder_(std::move(plan_folder)), console_(console) {}

    const stroke::Model& model_of(const variants::Task& task) {
        if (!loaded_ || !(choice_ == task.model)) {
            loaded_.reset();
            loaded_.emplace(
                load_model(variants::find_input(folder_, task.model.file), arguments_of(task).surface, console_));
            choice_ = task.model;
        }
        return loaded_->model;
    }

    variants::Outcome paint(const variants::Task& task);

  private:
    Paint arguments_of(const variants::Task& task) const;

    fs::path folder_;
    Console& console_;
    variants::ModelChoice choice_;
    std::optional<Loaded> loaded_;
};

Paint TaskPainter::arguments_of(const variants::Task& t) const {
    const auto preset = [&](const std::string& name) {
        return fs::path(name).extension() == ".toml" ? variants::find_input(folder_, name).string() : name;
    };
    Paint a;
    a.model = variants::find_input(folder_, t.model.file);
    a.strokes = {variants::find_input(folder_, t.strokes)};
    a.stroke.brush = preset(t.brush);
    a.stroke.ink = preset(t.ink);
    a.drawing.fit_brush = t.painting.fit_brush;
    a.wet.film = t.painting.film;
    a.stroke.dip = t.painting.dip;
    a.place.at_mm = t.placement.at_mm;
    a.place.on = t.placement.side;
    a.place.width_mm = t.placement.width_mm;
    a.place.turn_deg = t.placement.turn_deg;
    a.place.mapping = t.placement.mapping;
    a.surface.unit = t.model.unit;
    a.surface.up = t.model.up;
    a.surface.atlas_size = t.model.atlas_size;
    a.surface.substrate = preset(t.painting.substrate);
    a.view.width = t.picture.width;
    a.view.height = t.picture.height;
    if (t.picture.view_deg.size() == 2) {
        a.view.directed = true;
        a.view.azimuth = t.picture.view_deg[0];
        a.view.elevation = t.picture.view_deg[1];
    }
    return a;
}

/// Figures of the strokes that were painted. `off`: by stroke on the model, whether it leaves the surface.
void count_strokes(variants::Figures& f, const stroke::JournalEntry& entry, const stroke::StrokeReport& report,
                   const std::vector<bool>& off, std::size_t& n_on_model) {
    f.ink_mm3 += report.ink_given * ink::kFilmUnit * 1e9;
    if (!entry.as<stroke::PaintStroke>()) return;
    ++f.strokes;
    if (report.ran_dry()) ++f.dry;
    if (report.unconverged > 0) ++f.unconverged;
    if (stroke::on_palette(entry)) return;
    const std::size_t i = n_on_model++;
    if (!report.touched() || (i < off.size() && off[i])) ++f.mismatches;
}

/// Looks at the middle of the drawing.
void look_closer(View& view, double zoom, const std::vector<stroke::JournalEntry>& strokes,
                 const stroke::Model& model) {
    Box box;
    std::vector<bool> off;
    for (const Vec3f& foot : variants::feet_of(strokes, model, off)) box.add(Vec3(foot));
    if (box.empty()) return;
    const Vec3 middle = box.centre() / kMillimetre;
    view.target_mm = {middle.x, middle.y, middle.z};
    view.zoom = zoom;
}

variants::Outcome TaskPainter::paint(const variants::Task& task) {
    const auto start = Clock::now();
    Paint a = arguments_of(task);
    std::vector<stroke::JournalEntry> strokes = load_strokes(a, console_);
    const stroke::Model& model = model_of(task);
    place_strokes(strokes, model, a, console_);
    if (!a.view.directed) look_at_strokes(a.view, strokes, model);
    if (task.picture.zoom > 1) look_closer(a.view, task.picture.zoom, strokes, model);
    if (task.sample > 0) variants::deviate(strokes, task.tolerance, task.seed);
    stroke::Document painting(model, {.substrate = a.surface.substrate, .tip_lags = tip_lag_cache(a.surface)});
    prepare_strokes(strokes, painting, a, console_);
    check_sizes(strokes, painting, model, a);
    variants::Outcome out;
    variants::Figures& f = out.figures;
    std::vector<bool> off;
    std::vector<Vec3f> feet = variants::feet_of(strokes, model, off);
    std::size_t n_on_model = 0;
    painting.paint(
        std::move(strokes),
        [&](const stroke::JournalEntry& entry, const stroke::StrokeReport& report) {
            count_strokes(f, entry, report, off, n_on_model);
        },
        console_.progress());
    double area = 0;
    out.coverage = variants::coverage_of(painting, area);
    out.coverage.feet = std::move(feet);
    f.canvas_hash = fmt::format("{:016x}", painting.layers().hash());
    f.ink_area_mm2 = area * 1e6;
    f.view_deg = {a.view.azimuth, a.view.elevation};
    f.substrate = a.surface.substrate;
    if (task.picture.has(task.sample))
        out.picture = draw_picture({.model = model, .painting = &painting, .view = a.view}, console_);
    f.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return out;
}

fs::path own_program() {
    std::error_code ec;
    const fs::path program = fs::read_symlink("/proc/self/exe", ec);
    return ec ? fs::path("tuft") : program;
}

/// The tasks of a plan or of a folder.
variants::Jobs open_jobs(const VariantsWork& a) {
    std::error_code ec;
    if (fs::is_directory(a.plan, ec)) {
        if (!a.output.empty()) throw UsageError("-o: the folder of the tasks is given already");
        return variants::Jobs(fs::absolute(a.plan));
    }
    if (a.output.empty()) throw UsageError("a plan needs a folder for its tasks: -o FOLDER");
    const variants::Plan plan = variants::read_plan(a.plan);
    variants::Jobs jobs = variants::lay_out(plan, variants::tasks_of(plan), fs::absolute(a.output));
    variants::write_scripts(
        {.folder = jobs.folder(), .program = own_program(), .name = jobs.name(), .tasks = jobs.size()});
    return jobs;
}

/// Puts the models of open tasks into the cache, so that the workers do not all prepare the same one at once.
void prepare_models(const variants::Jobs& jobs, TaskPainter& painter) {
    for (std::size_t i = 0; i < jobs.size(); ++i)
        if (jobs.state(i) == variants::TaskState::open) painter.model_of(jobs.task(i));
}

void run_jobs(const variants::Jobs& jobs, Console& console) {
    std::size_t damaged = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        jobs.forget_failure(i);
        damaged += jobs.remove_damaged(i);
    }
    if (damaged > 0) console.note(counted(damaged, "damaged result") + " is painted again");
    {
        TaskPainter painter(jobs.plan_folder(), console);
        try {
            prepare_models(jobs, painter);
        } catch (const Error&) {  // its tasks will say so
        }
    }
    release_free_memory();
    variants::WorkerOptions options;
    options.command = {
        own_program().string(), "run-task", jobs.folder().string(), "--rest", "--threads", "1", "--quiet"};
    options.workers = thread_count();
    options.progress = console.progress();
    const variants::WorkersReport done = variants::run_workers(jobs, options);
    if (done.ended > 0) console.note(counted(done.ended, "worker") + " ended early, and others took their place");
}

struct Counts {
    std::size_t done = 0, failed = 0, open = 0;
    std::string fault;  // the first
};

Counts count(const std::vector<variants::Row>& rows) {
    Counts n;
    for (const variants::Row& row : rows) {
        ++(row.state == variants::TaskState::done     ? n.done
           : row.state == variants::TaskState::failed ? n.failed
                                                      : n.open);
        if (!row.fault.empty() && n.fault.empty())
            n.fault = fmt::format("task {} ({}): {}", row.index, row.task.name, row.fault);
    }
    return n;
}

void store_text(const fs::path& file, const std::string& text) {
    write_file(file, text.data(), text.size());
}

/// Writes all that is made of the results. Returns the exit status.
int gather_jobs(const variants::Jobs& jobs, const VariantsWork& a, Console& console) {
    const std::vector<variants::Row> rows = variants::gather(jobs);
    const std::string json = variants::json_of(jobs, rows);
    store_text(jobs.folder() / "table.csv", variants::csv_of(jobs, rows));
    store_text(jobs.folder() / "table.json", json);
    const auto sheets = variants::write_contact_sheets(jobs, rows, console.progress());
    TaskPainter painter(jobs.plan_folder(), console);
    const auto maps = variants::write_tolerance_maps(
        jobs, rows, [&](const variants::Task& task) -> const stroke::Model& { return painter.model_of(task); },
        console.progress());
    console.clear();
    const Counts n = count(rows);
    if (a.common.json) {
        fmt::print("{}", json);
    } else {
        fmt::print("{} of {} done, {} failed, {} open\n", n.done, counted(rows.size(), "variant"), n.failed, n.open);
        for (const variants::MapRow& m : maps)
            fmt::print("{}: moves {:.3g} mm (rms), 95 % within {:.3g} mm; overlaps its plan by {:.0f} %\n", m.name,
                       m.figures.rms_mm, m.figures.most_95_mm, 100 * m.figures.overlap);
        fmt::print("wrote table.csv, table.json, {}{} to {}\n", counted(sheets.size(), "contact sheet"),
                   maps.empty() ? "" : ", " + counted(2 * maps.size(), "tolerance map"), jobs.folder().string());
    }
    std::fflush(stdout);
    if (n.failed > 0) throw Error(fmt::format("{} of {} failed, the first {}", n.failed, rows.size(), n.fault));
    return n.open > 0 ? 1 : 0;
}

}  // namespace

int run(const VariantsWork& a) {
    Console console(a.common.quiet);
    const variants::Jobs jobs = open_jobs(a);
    if (a.run) run_jobs(jobs, console);
    if (a.run || a.gather) return gather_jobs(jobs, a, console);
    console.clear();
    fmt::print("{} in {}: run them with 'tuft variants {} --run', sbatch slurm.sh or parallel.sh\n",
               counted(jobs.size(), "variant"), jobs.folder().string(), jobs.folder().string());
    return 0;
}

int run(const RunTask& a) {
    if (a.index < 0 && !a.rest) throw UsageError("which task is to be run is not given: INDEX or --rest");
    Console console(true);
    const variants::Jobs jobs(fs::absolute(a.folder));
    TaskPainter painter(jobs.plan_folder(), console);
    const variants::PaintTask paint = [&](const variants::Task& task) { return painter.paint(task); };
    if (a.rest) return variants::run_open_tasks(jobs, paint, true).failed > 0 ? 1 : 0;
    if (static_cast<std::size_t>(a.index) >= jobs.size())
        throw Error(
            fmt::format("{}: there is no task {}; they are 0 to {}", a.folder.string(), a.index, jobs.size() - 1));
    const std::size_t end =
        std::min(jobs.size(), static_cast<std::size_t>(a.index) + static_cast<std::size_t>(a.count));
    variants::ContentHashes known;
    std::string fault;
    for (auto i = static_cast<std::size_t>(a.index); i < end; ++i) {
        const variants::TaskResult ran = variants::run_task(jobs, i, paint, known);
        if (ran == variants::TaskResult::failed && fault.empty())
            fault = fmt::format("task {}: {}", i, jobs.failure(i));
        if (!a.common.quiet)
            fmt::print("task {}: {}\n", i,
                       ran == variants::TaskResult::painted       ? "painted"
                       : ran == variants::TaskResult::done_before ? "was done before"
                       : ran == variants::TaskResult::taken       ? "another process has it"
                                                                  : "failed");
    }
    if (!fault.empty()) throw Error(fault);
    return 0;
}

}  // namespace tuft::cli
