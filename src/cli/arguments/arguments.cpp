#include "cli/arguments/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <type_traits>

#include "brush/preset/preset.h"
#include "cli/arguments/options.h"
#include "cli/arguments/reference.h"
#include "core/error.h"
#include "core/text/text.h"
#include "ink/composite/match.h"
#include "io/export/export_maps.h"
#include "io/model/read_model.h"

namespace tuft::cli {
namespace {

constexpr std::size_t kLongestMessage = 600;  // bytes

// Values that are names of presets.
void name_presets(CLI::App& app) {
    for (const char* name : {"--brush", "--ink", "--to-ink", "--substrate", "--material"})
        for (CLI::App* command : app.get_subcommands({}))
            if (CLI::Option* option = command->get_option_no_throw(name))
                option->type_name(std::string_view(name) == "--brush"       ? "BRUSH"
                                  : std::string_view(name).ends_with("ink") ? "INK"
                                                                            : "SUBSTRATE");
}

/// Nothing that an option takes is nothing: `--ink ""` is a slip, most often of a script.
void check_no_empty_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty()) throw CLI::ValidationError(option->get_name(), "its value is empty");
    for (const CLI::App* command : app.get_subcommands()) check_no_empty_values(*command);
}

CLI::App* add_paint(CLI::App& app, Paint& paint) {
    auto* command = app.add_subcommand("paint", "paint recorded strokes onto a model, or go on with a project");
    allow_shipped(command->add_option("MODEL", paint.model, std::string("mesh (") + io::kModelFormats + ") or project"))
        ->required();
    allow_shipped(command->add_option("--strokes", paint.strokes,
                                      "stroke files (.inkml) and drawings (.svg), painted in the order given"))
        ->required();
    add_paint_options(command, paint);
    add_pointer_options(command, paint);
    return command;
}

CLI::App* add_write(CLI::App& app, Write& write) {
    auto* command = app.add_subcommand("write", "write a text onto a model, as a calligrapher does");
    allow_shipped(command->add_option("MODEL", write.model, std::string("mesh (") + io::kModelFormats + ") or project"))
        ->required();
    add_paint_options(command, write);
    add_write_options(command, write);
    return command;
}

CLI::App* add_inspect(CLI::App& app, Inspect& inspect) {
    auto* command = app.add_subcommand("inspect", "say what is in a mesh or a project, and what is wrong with it");
    allow_shipped(command->add_option("FILE", inspect.file, "mesh or project"))->required();
    add_reading(command, inspect,
                "unit of the numbers in the model file (default: as it states, else a guess from its size)");
    auto* spot =
        add_point(command, "--at", inspect.at_mm, "say which pigments lie at this point of a project, in millimetres");
    command->add_option("--save-ink", inspect.save_ink, "write them as an ink (.toml), for --ink")->needs(spot);
    command->add_flag("--palette", inspect.palette, "the point is one of the palette, from its middle, z = 0")
        ->needs(spot);
    return command;
}

CLI::App* add_unwrap(CLI::App& app, Unwrap& unwrap) {
    auto* command = app.add_subcommand("unwrap", "make a texture atlas for a model");
    allow_shipped(command->add_option("MODEL", unwrap.model, "mesh"))->required();
    command->add_option("-o,--output", unwrap.output, "write the model with its UVs (.obj or .glb)")->required();
    command->add_option("--picture", unwrap.picture, "write a picture of the atlas (.png)");
    add_surface(command, unwrap.surface);
    return command;
}

CLI::App* add_decimate(CLI::App& app, Decimate& decimate) {
    auto* command = app.add_subcommand("decimate", "make a working copy of a large scan with fewer triangles");
    allow_shipped(command->add_option("MODEL", decimate.model, "mesh"))->required();
    command->add_option("-o,--output", decimate.output, "write the working copy (.ply)")->required();
    command->add_option("--triangles", decimate.triangles, "most triangles of the copy")
        ->check(number_in(4, kMostTexels, "POSITIVE"));
    command
        ->add_option("--error", decimate.error_mm,
                     "collapse no edge that moves the surface by more, in millimetres, as a mean; single vertices may "
                     "lie some times as far, and how far is printed")
        ->check(number_in(1e-9, kFarthestMm, "POSITIVE"));
    add_reading(command, decimate,
                "unit of the numbers in the model file (default: as it states, else a guess from its size)");
    return command;
}

CLI::App* add_replay(CLI::App& app, Replay& replay) {
    auto* command = app.add_subcommand("replay", "paint a project's strokes again, on the same or a revised model");
    command->add_option("PROJECT", replay.project, "project file (.tuft)")->required();
    auto* model = allow_shipped(command->add_option("--model", replay.model, "paint onto this revised mesh instead"));
    command
        ->add_option("--follow", replay.follow,
                     "where the revised model, or a part of it, was moved, turned or scaled, its strokes go with it: "
                     "parts (default), stretch (a body that became longer or wider carries them too), or none (strokes "
                     "stay where they were)")
        ->check(CLI::IsMember({"parts", "stretch", "none"}))
        ->needs(model);
    command
        ->add_flag("--pull-back", replay.pull_back,
                   "pull strokes of a hand in space onto the revised surface, as deep as they were pressed before")
        ->needs(model);
    command
        ->add_option(
            "--moved", replay.moved,
            "write a picture of what moved (.png): changed surface by its distance, strokes that no longer fit")
        ->needs(model);
    command->add_option("--brush", replay.brush, "use this brush for every stroke");
    command->add_option("--ink", replay.ink,
                        "use this ink for every stroke: a name, a .toml file or a colour such as '#c03020'");
    add_surface(command, replay.surface);
    add_cache(command, replay.surface);
    add_recolouring(command, replay.recolouring);
    command->add_option("--project", replay.out_project, "write a project file (.tuft)");
    command->add_option("-o,--export", replay.exported, "write the textured model: .glb, .gltf or .obj");
    command->add_option("--preview", replay.preview, "write a picture (.png)");
    add_view(command, replay.view);
    return command;
}

CLI::App* add_export(CLI::App& app, Export& exported) {
    auto* command = app.add_subcommand("export", "write a project's textured model, maps or strokes");
    command->add_option("PROJECT", exported.project, "project file (.tuft)")->required();
    command
        ->add_option(
            "-o,--output", exported.output,
            ".glb, .gltf, .obj, .3mf (model); .png, .exr (one map); .ora (layers, OpenRaster); .inkml (strokes, to the "
            "bit)")
        ->required();
    command
        ->add_option("--map", exported.map,
                     "which map a .png or .exr holds: base-colour, normal, height, roughness, pigments (.exr), "
                     "layers (.exr) or palette (.png); "
                     "default: the file's name if it is one of these, else base-colour")
        ->check(CLI::IsMember(io::map_names()));
    command->add_option("--bits", exported.bits, "8 or 16 bits a channel of base-colour.png")
        ->check(CLI::IsMember({8, 16}));
    command
        ->add_option("--colour-space", exported.colour_space,
                     "of base-colour and layers, whose profile is stored: srgb (default), display-p3, or acescg "
                     "(linear: .exr, or .png with 16 bits)")
        ->check(CLI::IsMember(ink::colour_space_names()));
    auto* filaments =
        command
            ->add_option("--filaments", exported.filaments,
                         ".3mf: paint triangles in these filaments instead of a texture: colours (#f4f2ea,#203060,...) "
                         "or a .toml file; the first is the core")
            ->type_name("COLOURS");
    command->add_option("--wall", exported.wall_mm, "painted wall in mm, through which the core shows (default: 0.45)")
        ->check(number_in(0.01, 100.0))
        ->needs(filaments);
    command
        ->add_option("--detail", exported.detail_mm,
                     "halve triangles of several colours until their edges are shorter, in mm (default: 0.5)")
        ->check(number_in(0.01, 1000.0))
        ->needs(filaments);
    add_recolouring(command, exported.recolouring);
    add_layers(command, exported.layers);
    return command;
}

CLI::App* add_layer(CLI::App& app, LayerWork& layer) {
    auto* command = app.add_subcommand("layer", "change a project's layers");
    command->add_option("PROJECT", layer.project, "project file (.tuft)")->required();
    command
        ->add_option("WHAT", layer.what,
                     "add, remove, show, hide, lock, unlock, opacity, blend, rename, move, duplicate or merge (into "
                     "the one below)")
        ->required()
        ->check(CLI::IsMember({"add", "remove", "show", "hide", "lock", "unlock", "opacity", "blend", "rename", "move",
                               "duplicate", "merge"}));
    command->add_option("NAME", layer.name, "name of the layer")->required();
    command->add_option("VALUE", layer.value,
                        "opacity (0 to 1), blend (normal, glaze, multiply), new name, or place (1 is the lowest)");
    return command;
}

CLI::App* add_part(CLI::App& app, PartWork& part) {
    auto* command =
        app.add_subcommand("part", "list and change the parts of a project's model: the groups of its file");
    command->add_option("PROJECT", part.project, "project file (.tuft)")->required();
    command
        ->add_option("WHAT", part.what,
                     "list, hide, show, isolate (show these alone), lock, unlock or substrate. Hidden parts are as if "
                     "they were not there: strokes go through to what lies behind them. Locked parts are touched and "
                     "get no ink")
        ->check(CLI::IsMember({"list", "hide", "show", "isolate", "lock", "unlock", "substrate"}));
    command->add_option(
        "NAME", part.names,
        "names of parts (list, show, lock and unlock: all without any); with substrate PART=NAME, where NAME "
        "is that of a substrate, a .toml file, or none for the project's");
    return command;
}

CLI::App* add_fill(CLI::App& app, FillWork& fill) {
    auto* command =
        app.add_subcommand("fill", "cover a whole project, a part or a chart of it with ink, even or graded");
    command->add_option("PROJECT", fill.project, "project file (.tuft)")->required();
    command->add_option("--ink", fill.ink, "ink to fill with: a name, a .toml file or a colour such as '#c03020'");
    command->add_option("--film", fill.film, "film units of 10 um of wet ink (default: what a full brush leaves)")
        ->check(number_in(0.0, 1000.0));
    command->add_option("--to-ink", fill.to_ink, "ink at the other end of a gradient (default: the same)");
    command->add_option("--to-film", fill.to_film, "film at the other end of a gradient (default: the same)")
        ->check(number_in(0.0, 1000.0));
    auto* from = add_point(command, "--from", fill.from_mm, "where the gradient begins, in millimetres");
    auto* to = add_point(command, "--to", fill.to_mm, "where it ends");
    from->needs(to);
    to->needs(from);
    command->add_flag("--round", fill.round, "grade by the distance from the first point")->needs(from);
    auto* part = add_point(command, "--part", fill.part_mm, "fill only what hangs together with the surface here");
    add_point(command, "--chart", fill.chart_mm, "fill only the chart of the atlas here")->excludes(part);
    command->add_option("--mask", fill.mask, "fill only what lies in this mask");
    command->add_option("--layer", fill.layer, "layer to fill; it is made when there is none yet");
    command->add_flag("--palette", fill.palette,
                      "pour it onto the palette (points in millimetres from its middle, z = 0)");
    return command;
}

CLI::App* add_mask(CLI::App& app, MaskWork& mask) {
    auto* command = app.add_subcommand("mask", "make a mask in a project: strokes and fills that name it keep to it");
    command->add_option("PROJECT", mask.project, "project file (.tuft)")->required();
    command->add_option("NAME", mask.name, "name of the mask")->required();
    command->require_option(2, 0);
    command->add_option("--group", mask.groups, "the mesh's groups of these names")->delimiter(',');
    add_point(command, "--facing", mask.direction, "where the surface faces this direction");
    command
        ->add_option("--clear-of-edges", mask.clear_mm,
                     "what is farther than this from borders and from edges sharper than --within degrees, in "
                     "millimetres")
        ->check(number_in(0.001, 1000.0))
        ->type_name("MM");
    command->add_option("--within", mask.within, "to within so many degrees")->check(number_in(0.0, 180.0));
    command->add_option("--soft", mask.soft, "with an edge of so many degrees to either side")
        ->check(number_in(0.0, 180.0));
    add_point(command, "--chart", mask.chart_mm, "the chart of the atlas at this point, in millimetres");
    command->add_option(
        "--lasso", mask.lasso.points,
        "what this polygon encloses: 'X,Y X,Y X,Y ...', millimetres right and up of the middle as seen from --view");
    add_view_direction(command, mask.lasso.view);
    command->add_flag("--through", mask.lasso.through, "the lasso also takes what faces away or is hidden");
    command->add_option("--invert", mask.invert, "what this mask leaves out");
    command->add_option("--intersect", mask.intersect, "what lies in all of these masks: NAME,...")->delimiter(',');
    command->add_option("--unite", mask.unite, "what lies in any of these masks: NAME,...")->delimiter(',');
    command->add_flag("--remove", mask.remove, "end the mask; what was painted under it stays");
    return command;
}

CLI::App* add_render(CLI::App& app, Render& render) {
    auto* command = app.add_subcommand("render", "draw a picture of a model or a project");
    allow_shipped(command->add_option("FILE", render.file, "mesh or project"))->required();
    command->add_option("-o,--output", render.output, "picture (.png); with --turntable a number is added")->required();
    command->add_option("--turntable", render.turntable, "draw N pictures all round")->check(number_in(1, 3600));
    add_reading(command, render,
                "unit of the numbers in a model file (default: as it states, else a guess from its size)");
    add_recolouring(command, render.recolouring);
    command->add_option("--material", render.material, "porcelain, clay, ... (default: the project's)");
    add_view(command, render.view);
    return command;
}

CLI::App* add_brush(CLI::App& app, Brush& brush) {
    auto* command = app.add_subcommand("brush", "print a brush's query table, draw it, or fit one to measurements");
    command->add_option("BRUSH", brush.name, "brush name or .toml file; without it, the names are listed");
    command->add_option(
        "--picture", brush.picture,
        "draw the tuft at five depths and three tilts, lifted, slanted, reversed, split and dry (.png)");
    command->add_option("--sweep-depth", brush.sweep_depth, "write line width over depth (.csv)");
    command->add_option("--compare", brush.compare,
                        "print what each spine method draws beside a measured table (.csv); --picture draws that");
    auto* fit = command->add_subcommand("calibrate",
                                        "fit a brush to a table of depth against line width, contact length or offset");
    fit->add_option("MEASURED", brush.calibrate, "measured table (.csv): z_mm and any of width_mm, drag_mm, offset_mm")
        ->required();
    fit->add_option("-o,--output", brush.output, "brush preset to write (.toml)")->required();
    auto* match = command->add_subcommand("match", "rank the brushes by how well they draw a measured table");
    match->add_option("MEASURED", brush.match, "measured table (.csv): z_mm and any of width_mm, drag_mm, offset_mm")
        ->required();
    fit->fallthrough();  // options of 'brush' also stand behind 'calibrate'
    match->fallthrough();
    return command;
}

CLI::App* add_bias(CLI::App& app, BiasCorrection& bias) {
    auto* command =
        app.add_subcommand("bias", "learn how a writer's strokes differ from those that were meant")->alias("habit");
    command->add_option("INTENDED", bias.intended, "strokes as they should be (.inkml)")->required();
    command->add_option("WRITTEN", bias.written, "the same strokes as the writer makes them (.inkml)")->required();
    command->add_option("-o,--output", bias.output, "bias correction to write (.toml)")->required();
    return command;
}

CLI::App* add_ink(CLI::App& app, InkWork& ink) {
    auto* command = app.add_subcommand("ink", "list the inks, or find the mix of pigments nearest to a colour");
    auto* match =
        command->add_subcommand("match", "find the mix of pigments nearest to a colour, by Kubelka-Munk and CIEDE2000");
    match
        ->add_option("COLOUR", ink.colour,
                     "sRGB as '#rrggbb' (quoted: a shell takes an open # for a comment) or rrggbb")
        ->required();
    match->add_option("--substrate", ink.substrate, "what it is painted on: porcelain, bisque, clay, ...");
    match
        ->add_option(
            "--film", ink.film,
            "thickness of the wet film in film units of 10 um (default, or 0: 2, or 4 or 8 where the colour needs it)")
        ->check(number_in(0.0, ink::kThickestMix));
    match->add_option("--pigments", ink.pigments, "choose from these pigments only: NAME,... or FILE.toml,...")
        ->delimiter(',');
    match->add_option("--parts", ink.parts, "most pigments in the mix")->check(number_in(1, 4));
    match->add_option("-o,--output", ink.output, "write the mix as an ink (.toml), for --ink");
    add_common(match, ink.common);
    return command;
}

CLI::App* add_bench(CLI::App& app, Bench& bench) {
    auto* command = app.add_subcommand("bench", "measure the speed on this machine");
    allow_shipped(command->add_option("MODEL", bench.model, "measure on this mesh instead of the built-in ones"));
    command->add_flag("--quick", bench.quick, "smaller models, fewer repeats");
    command->add_option("--atlas-size", bench.surface.atlas_size, "texels along the side of the atlas")
        ->check(number_in(1, kMostTexels, "POSITIVE"));
    command->add_option("--isa", bench.isa, "instruction set of the stamps: best, avx512, avx2, baseline")
        ->check(CLI::IsMember({"best", "avx512", "avx2", "baseline"}));
    auto* scaling = command->add_option("--scaling", bench.scaling,
                                        "measure only how painting, wet ink and preparing a model go with these "
                                        "numbers of threads, as in 1,2,4,8");
    scaling->delimiter(',')->check(number_in(1, 1024, "THREADS"));
    command
        ->add_option("--seconds", bench.seconds,
                     "seconds within which measurements over numbers of threads are repeated, after a first round "
                     "(default: 90)")
        ->check(number_in(0, 3600));
    auto* report = command->add_option("--report", bench.report,
                                       "write a page of figures with plots (.html or .md), and its numbers as .json "
                                       "beside it; also measures how speed goes with threads, triangles and texels");
    command
        ->add_option("--against", bench.against,
                     "numbers of an earlier report (.json) to compare with (default: those that the page replaces)")
        ->needs(report);
    scaling->excludes(report);
    add_store(command, bench.surface);
    return command;
}

/// A command with the arguments that its options fill.
struct Entry {
    CLI::App* app;
    std::function<Command()> arguments;
};

template <class T>
Entry make_entry(CLI::App& app, CLI::App* (*add)(CLI::App&, T&)) {
    const auto arguments = std::make_shared<T>();
    CLI::App* command = add(app, *arguments);
    if constexpr (!std::is_same_v<T, DeviceWork>)
        add_common(command, arguments->common);  // those of `device` have them
    return {command, [arguments] { return Command(*arguments); }};
}

/// Adds all commands, in the order of --help, each with the options of `add_common` at its end.
std::vector<Entry> add_commands(CLI::App& app) {
    return {
        make_entry(app, add_paint),    make_entry(app, add_write),    make_entry(app, add_inspect),
        make_entry(app, add_unwrap),   make_entry(app, add_decimate), make_entry(app, add_replay),
        make_entry(app, add_export),   make_entry(app, add_decals),   make_entry(app, add_trajectory),
        make_entry(app, add_variants), make_entry(app, add_run_task), make_entry(app, add_layer),
        make_entry(app, add_part),     make_entry(app, add_fill),     make_entry(app, add_mask),
        make_entry(app, add_render),   make_entry(app, add_film),     make_entry(app, add_brush),
        make_entry(app, add_bias),     make_entry(app, add_ink),      make_entry(app, add_bench),
        make_entry(app, add_device),
    };
}

/// The words of the command that was given, such as tuft or tuft device test.
std::string command_words(const CLI::App& app) {
    std::string words = "tuft";
    for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
        at = at->get_subcommands().front();
        words += " " + at->get_name();
    }
    return words;
}

/// Parses the arguments. Returns false where the program ends with `status`: after a help text or a fault.
bool parse(CLI::App& app, int argc, const char* const* argv, int& status) {
    try {
        app.parse(argc, argv);
        check_no_empty_values(app);
        return true;
    } catch (const CLI::Success& wanted) {  // a help text or the version
        status = app.exit(wanted);
    } catch (const CLI::ParseError& error) {
        std::string line = error.what();
        if (const auto end = line.find('\n'); end != std::string::npos) line.resize(end);
        std::cerr << "tuft: " << excerpt(line, kLongestMessage) << " (see '" << command_words(app) << " --help')\n";
        status = 2;
    }
    return false;
}

}  // namespace

bool parse_arguments(int argc, const char* const* argv, Command& command, int& status) {
    CLI::App app{"tuft: ink and a bending hair brush on the surface of 3D models", "tuft"};
    bool json_version = false;
    auto* json = app.add_flag("--json", json_version,
                              "with --version: the libraries' versions and facts of the build, as one JSON object");
    json->needs(app.set_version_flag("--version", [&] { return version_text(json_version); }));
    app.require_subcommand(1);
    app.footer("Run 'tuft COMMAND --help' for the options of a command.");
    app.get_formatter()->column_width(34);

    const std::vector<Entry> commands = add_commands(app);
    name_presets(app);
    if (argc == 3 && std::string_view(argv[1]) == "--reference") {  // when the program is built
        write_manual(manual_of(app), argv[2]);
        status = 0;
        return false;
    }
    if (!parse(app, argc, argv, status)) return false;
    const auto called = std::find_if(commands.begin(), commands.end(), [](const Entry& e) { return e.app->parsed(); });
    command = called->arguments();
    return true;
}

}  // namespace tuft::cli
