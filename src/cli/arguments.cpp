#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>

#include "brush/preset/preset.h"
#include "cli/options.h"
#include "cli/reference.h"
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

    Paint paint;
    auto* p = app.add_subcommand("paint", "paint recorded strokes onto a model, or go on with a project");
    p->add_option("MODEL", paint.model, std::string("mesh (") + io::kModelFormats + ") or project")->required();
    p->add_option("--strokes", paint.strokes, "InkML files, painted in the order given")->required();
    add_paint_options(p, paint);

    Write write;
    auto* w = app.add_subcommand("write", "write a text onto a model, as a calligrapher does");
    w->add_option("MODEL", write.model, std::string("mesh (") + io::kModelFormats + ") or project")->required();
    add_paint_options(w, write);
    add_write_options(w, write);

    Inspect inspect;
    auto* i = app.add_subcommand("inspect", "say what is in a mesh or a project, and what is wrong with it");
    i->add_option("FILE", inspect.file, "mesh or project")->required();
    add_reading(i, inspect, "unit of the model file (default: a guess from its size)");
    auto* spot =
        add_point(i, "--at", inspect.at_mm, "say which pigments lie at this point of a project, in millimetres");
    i->add_option("--save-ink", inspect.save_ink, "write them as an ink (.toml), for --ink")->needs(spot);
    i->add_flag("--palette", inspect.palette, "the point is one of the palette, from its middle, z = 0")->needs(spot);
    add_common(i, inspect.common);

    Unwrap unwrap;
    auto* u = app.add_subcommand("unwrap", "make a texture atlas for a model");
    u->add_option("MODEL", unwrap.model, "mesh")->required();
    u->add_option("-o,--output", unwrap.output, "write the model with its UVs (.obj or .glb)")->required();
    u->add_option("--picture", unwrap.picture, "write a picture of the atlas (.png)");
    add_surface(u, unwrap.surface);
    add_common(u, unwrap.common);

    Replay replay;
    auto* r = app.add_subcommand("replay", "paint a project's strokes again, on the same or a revised model");
    r->add_option("PROJECT", replay.project, "project file (.tuft)")->required();
    r->add_option("--model", replay.model, "paint onto this revised mesh instead");
    r->add_option("--brush", replay.brush, "use this brush for every stroke");
    r->add_option("--ink", replay.ink,
                  "use this ink for every stroke: a name, a .toml file or a colour such as '#c03020'");
    add_surface(r, replay.surface);
    add_recolouring(r, replay.recolouring);
    r->add_option("--project", replay.out_project, "write a project file (.tuft)");
    r->add_option("--export", replay.exported, "write the textured model: .glb, .gltf or .obj");
    r->add_option("--preview", replay.preview, "write a picture (.png)");
    add_view(r, replay.view);
    add_common(r, replay.common);

    Export exported;
    auto* e = app.add_subcommand("export", "write a project's textured model, maps or strokes");
    e->add_option("PROJECT", exported.project, "project file (.tuft)")->required();
    e->add_option("-o,--output", exported.output,
                  ".glb, .gltf, .obj (model); .png, .exr (one map); .inkml (strokes, to the bit)")
        ->required();
    e->add_option(
         "--map", exported.map,
         "which map a .png or .exr holds: base-colour, normal, height, roughness, pigments (.exr) or palette (.png); "
         "default: the file's name if it is one of these, else base-colour")
        ->check(CLI::IsMember(io::map_names()));
    e->add_option("--bits", exported.bits, "8 or 16 bits a channel of base-colour.png")->check(CLI::IsMember({8, 16}));
    add_recolouring(e, exported.recolouring);
    add_layers(e, exported.layers);
    add_common(e, exported.common);

    Decals decals;
    auto* c = add_decals(app, decals);
    TrajectoryWork trajectory;
    auto* t = add_trajectory(app, trajectory);

    LayerWork layer;
    auto* l = app.add_subcommand("layer", "change a project's layers");
    l->add_option("PROJECT", layer.project, "project file (.tuft)")->required();
    l->add_option(
         "WHAT", layer.what,
         "add, remove, show, hide, lock, unlock, opacity, blend, rename, move, duplicate or merge (into the one below)")
        ->required()
        ->check(CLI::IsMember({"add", "remove", "show", "hide", "lock", "unlock", "opacity", "blend", "rename", "move",
                               "duplicate", "merge"}));
    l->add_option("NAME", layer.name, "name of the layer")->required();
    l->add_option("VALUE", layer.value,
                  "opacity (0 to 1), blend (normal, glaze, multiply), new name, or place (1 is the lowest)");
    add_common(l, layer.common);

    FillWork fill;
    auto* f = app.add_subcommand("fill", "cover a whole project, a part or a chart of it with ink, even or graded");
    f->add_option("PROJECT", fill.project, "project file (.tuft)")->required();
    f->add_option("--ink", fill.ink, "ink to fill with: a name, a .toml file or a colour such as '#c03020'");
    f->add_option("--film", fill.film, "film units of 10 um of wet ink (default: what a full brush leaves)")
        ->check(number_in(0.0, 1000.0));
    f->add_option("--to-ink", fill.to_ink, "ink at the other end of a gradient (default: the same)");
    f->add_option("--to-film", fill.to_film, "film at the other end of a gradient (default: the same)")
        ->check(number_in(0.0, 1000.0));
    auto* from = add_point(f, "--from", fill.from_mm, "where the gradient begins, in millimetres");
    auto* to = add_point(f, "--to", fill.to_mm, "where it ends");
    from->needs(to);
    to->needs(from);
    f->add_flag("--round", fill.round, "grade by the distance from the first point")->needs(from);
    auto* part = add_point(f, "--part", fill.part_mm, "fill only what hangs together with the surface here");
    add_point(f, "--chart", fill.chart_mm, "fill only the chart of the atlas here")->excludes(part);
    f->add_option("--mask", fill.mask, "fill only what lies in this mask");
    f->add_option("--layer", fill.layer, "layer to fill; it is made when there is none yet");
    f->add_flag("--palette", fill.palette, "pour it onto the palette (points in millimetres from its middle, z = 0)");
    add_common(f, fill.common);

    MaskWork mask;
    auto* k = app.add_subcommand("mask", "make a mask in a project: strokes and fills that name it keep to it");
    k->add_option("PROJECT", mask.project, "project file (.tuft)")->required();
    k->add_option("NAME", mask.name, "name of the mask")->required();
    k->require_option(2, 0);
    k->add_option("--group", mask.groups, "the mesh's groups of these names")->delimiter(',');
    add_point(k, "--facing", mask.direction, "where the surface faces this direction");
    k->add_option("--within", mask.within, "to within so many degrees")->check(number_in(0.0, 180.0));
    k->add_option("--soft", mask.soft, "with an edge of so many degrees to either side")->check(number_in(0.0, 180.0));
    add_point(k, "--chart", mask.chart_mm, "the chart of the atlas at this point, in millimetres");
    k->add_option(
        "--lasso", mask.lasso,
        "what this polygon encloses: 'X,Y X,Y X,Y ...', millimetres right and up of the middle as seen from --view");
    add_view_direction(k, mask.view);
    k->add_flag("--through", mask.through, "the lasso also takes what faces away or is hidden");
    k->add_option("--invert", mask.invert, "what this mask leaves out");
    k->add_option("--intersect", mask.intersect, "what lies in all of these masks: NAME,...")->delimiter(',');
    k->add_option("--unite", mask.unite, "what lies in any of these masks: NAME,...")->delimiter(',');
    k->add_flag("--remove", mask.remove, "end the mask; what was painted under it stays");
    add_common(k, mask.common);

    Render render;
    auto* d = app.add_subcommand("render", "draw a picture of a model or a project");
    d->add_option("FILE", render.file, "mesh or project")->required();
    d->add_option("-o,--output", render.output, "picture (.png); with --turntable a number is added")->required();
    d->add_option("--turntable", render.turntable, "draw N pictures all round")->check(number_in(1, 3600));
    add_reading(d, render, "unit of a model file (default: a guess from its size)");
    add_recolouring(d, render.recolouring);
    d->add_option("--material", render.material, "porcelain, clay, ... (default: the project's)");
    add_view(d, render.view);
    add_common(d, render.common);

    Brush brush;
    auto* b = app.add_subcommand("brush", "print a brush's query table, draw it, or fit one to measurements");
    b->add_option("BRUSH", brush.name, "brush name or .toml file; without it, the names are listed");
    b->add_option("--picture", brush.picture,
                  "draw the tuft at five depths and three tilts, lifted, slanted, reversed, split and dry (.png)");
    b->add_option("--sweep-depth", brush.sweep_depth, "write line width over depth (.csv)");
    b->add_option("--compare", brush.compare,
                  "print what each way to bend the tuft draws beside a measured table (.csv); --picture draws that");
    auto* fit = b->add_subcommand("calibrate", "fit a brush to a table of depth against line width");
    fit->add_option("MEASURED", brush.calibrate, "measured table (.csv)")->required();
    fit->add_option("-o,--output", brush.output, "brush preset to write (.toml)")->required();
    add_common(b, brush.common);
    fit->fallthrough();  // options of 'brush' also stand behind 'calibrate'

    BiasCorrection bias;
    auto* h =
        app.add_subcommand("bias", "learn how a writer's strokes differ from those that were meant")->alias("habit");
    h->add_option("INTENDED", bias.intended, "strokes as they should be (.inkml)")->required();
    h->add_option("WRITTEN", bias.written, "the same strokes as the writer makes them (.inkml)")->required();
    h->add_option("-o,--output", bias.output, "bias correction to write (.toml)")->required();
    add_common(h, bias.common);

    InkWork ink;
    auto* inks = app.add_subcommand("ink", "list the inks, or find the mix of pigments nearest to a colour");
    auto* match =
        inks->add_subcommand("match", "find the mix of pigments nearest to a colour, by Kubelka-Munk and CIEDE2000");
    match
        ->add_option("COLOUR", ink.colour,
                     "sRGB as '#rrggbb' (quoted: a shell takes an open # for a comment) or rrggbb")
        ->required();
    match->add_option("--substrate", ink.substrate, "what it is painted on: porcelain, bisque, clay, ...");
    match
        ->add_option(
            "--film", ink.film,
            "thickness of the wet film in film units of 10 um (default, or 0: 2, or 4 or 8 where the colour needs it)")
        ->check(CLI::Range(0.0, ink::kThickestMix));
    match->add_option("--pigments", ink.pigments, "choose from these pigments only: NAME,... or FILE.toml,...")
        ->delimiter(',');
    match->add_option("--parts", ink.parts, "most pigments in the mix")->check(CLI::Range(1, 4));
    match->add_option("-o,--output", ink.output, "write the mix as an ink (.toml), for --ink");
    add_common(match, ink.common);
    add_common(inks, ink.common);

    Bench bench;
    auto* n = app.add_subcommand("bench", "measure the speed on this machine");
    n->add_option("MODEL", bench.model, "measure on this mesh instead of the built-in ones");
    n->add_flag("--quick", bench.quick, "smaller models, fewer repeats");
    n->add_option("--atlas-size", bench.surface.atlas_size, "texels along the side of the atlas")
        ->check(number_in(1, kMostTexels, "POSITIVE"));
    n->add_option("--isa", bench.isa, "instruction set of the stamps: best, avx512, avx2, baseline")
        ->check(CLI::IsMember({"best", "avx512", "avx2", "baseline"}));
    add_store(n, bench.surface);
    add_common(n, bench.common);

    DeviceWork device;
    add_device(app, device);

    name_presets(app);
    if (argc == 3 && std::string_view(argv[1]) == "--reference") {  // when the program is built
        write_manual(manual_of(app), argv[2]);
        status = 0;
        return false;
    }
    try {
        app.parse(argc, argv);
        check_no_empty_values(app);
    } catch (const CLI::CallForHelp& help) {
        status = app.exit(help);
        return false;
    } catch (const CLI::CallForAllHelp& help) {
        status = app.exit(help);
        return false;
    } catch (const CLI::CallForVersion& version) {
        status = app.exit(version);
        return false;
    } catch (const CLI::ParseError& error) {
        std::string line = error.what();
        if (const auto end = line.find('\n'); end != std::string::npos) line.resize(end);
        std::cerr << "tuft: " << excerpt(line, kLongestMessage) << " (see 'tuft --help')\n";
        status = 2;
        return false;
    }
    if (p->parsed())
        command = paint;
    else if (w->parsed())
        command = write;
    else if (i->parsed())
        command = inspect;
    else if (u->parsed())
        command = unwrap;
    else if (r->parsed())
        command = replay;
    else if (e->parsed())
        command = exported;
    else if (c->parsed())
        command = decals;
    else if (t->parsed())
        command = trajectory;
    else if (d->parsed())
        command = render;
    else if (b->parsed())
        command = brush;
    else if (h->parsed())
        command = bias;
    else if (l->parsed())
        command = layer;
    else if (f->parsed())
        command = fill;
    else if (k->parsed())
        command = mask;
    else if (inks->parsed())
        command = ink;
    else if (!device.what.empty())
        command = device;
    else
        command = bench;
    return true;
}

}  // namespace tuft::cli
