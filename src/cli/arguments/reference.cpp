#include "cli/arguments/reference.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/files/files.h"
#include "core/system/build_facts.h"

namespace tuft::cli {
namespace {

// CLI11 gives the value's type with what it is checked by: "TEXT:{rod,table}", "INT in [0 - 1024]".
ManualOption entry_of(const CLI::Option& option) {
    ManualOption entry;
    for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
    entry.text = option.get_description();
    entry.required = option.get_required();
    entry.repeats = option.get_expected_max() > 1;
    if (option.get_type_size_max() == 0) return entry;
    const std::string type = option.get_type_name();
    entry.value = type.substr(0, type.find_first_of(": "));
    if (entry.names.empty()) entry.value = option.get_name(true);
    const std::size_t open = type.find(":{"), close = type.find('}');
    if (open != std::string::npos && close != std::string::npos)
        entry.choices = CLI::detail::split(type.substr(open + 2, close - open - 2), ',');
    return entry;
}

ManualCommand command_of(const CLI::App& app) {
    ManualCommand command{.name = app.get_name(), .text = app.get_description()};
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty()) command.options.push_back(entry_of(*option));
    for (const CLI::App* part : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
        command.commands.push_back(command_of(*part));
    return command;
}

}  // namespace

Manual manual_of(const CLI::App& app) {
    Manual manual{.program = command_of(app), .version = build_facts().version, .date = build_facts().released};
    manual.program.text = "ink and a bending hair brush on the surface of 3D models";
    manual.sections = {{"DESCRIPTION",
                        "tuft makes a texture atlas for a mesh, lets a bending brush touch its surface, leaves "
                        "ink in the texels that it touched, "
                        "and writes a textured model. The strokes are kept in a project file, and are painted "
                        "again on other models, at other "
                        "resolutions and with other inks.\n\n"
                        "Each command has a page of its own. Lengths are in millimetres and angles in degrees."},
                       {"EXIT STATUS",
                        "0 when all was done, 1 when something failed, 2 for a wrong command line. Faults are one "
                        "line on standard error."},
                       {"ENVIRONMENT",
                        "TUFT_DATA is the folder with models/brushes, models/inks and models/substrates, in place "
                        "of the installed one."},
                       {"FILES",
                        "/usr/share/tuft/models has meshes, brushes, inks and substrates, /usr/share/tuft/samples "
                        "strokes to paint."},
                       {"EXAMPLES",
                        "Paint a line of writing round a bowl, keep the strokes, and write a model with its "
                        "texture:\n\n"
                        "  cd /usr/share/tuft\n"
                        "  tuft paint models/bowl.ply --strokes samples/strokes/man-bu-ren-sheng.inkml \\\n"
                        "      --project ~/bowl.tuft --export ~/bowl.glb\n\n"
                        "Paint the same strokes in blue on twice as many texels:\n\n"
                        "  tuft replay ~/bowl.tuft --ink cobalt --atlas-size 4096 --export ~/blue.glb\n"},
                       {"SEE ALSO", "tuft-studio(1) paints in a window."}};
    return manual;
}

std::string version_text(bool json) {
    const BuildFacts& facts = build_facts();
    if (!json) return "tuft " + facts.version;
    nlohmann::json j{{"program", "tuft"},
                     {"version", facts.version},
                     {"released", facts.released},
                     {"commit", facts.commit.empty() ? nlohmann::json() : nlohmann::json(facts.commit)},
                     {"licence", "MIT"},
                     {"compiler", facts.compiler},
                     {"build_type", facts.build_type},
                     {"system", facts.system},
                     {"data", data_folder().string()},
                     {"libraries", nlohmann::json::object()}};
    for (const auto& [name, version] : facts.libraries) j["libraries"][name] = version;
    return j.dump(2);
}

}  // namespace tuft::cli
