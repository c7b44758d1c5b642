#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <iostream>
#include <optional>

#include "brush/preset/preset.h"
#include "cli/reference.h"
#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/text.h"
#include "core/text/units.h"
#include "ink/composite/match.h"
#include "io/export/export_maps.h"
#include "io/model/read_model.h"
#include "stroke/drawing/free_area.h"
#include "stroke/journal/recorded_stroke.h"

// What help and manual call the value of an option that is a path.
template <>
constexpr const char* CLI::detail::type_name<std::filesystem::path>() {
    return "FILE";
}

namespace tuft::cli {
namespace {

constexpr double kFarthestMm = kFarthest / kMillimetre;
constexpr std::size_t kLongestMessage = 600;  // bytes
constexpr double kMostTexels = 1e9;           // along a side; memory is asked about later
constexpr double kLeastTexelMm = 1e-9;
constexpr double kMostDegrees = 36000;  // a hundred turns

/// The whole of `text` as a finite number; nothing for anything else.
std::optional<double> number_of(const std::string& text) {
    double value = 0;
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [last, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || last != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// "A,B[,C]" into numbers within ±`most`; empty when it is anything else.
std::vector<double> numbers(const std::string& text, char separator, std::size_t count, double most) {
    std::vector<double> values;
    std::stringstream stream(text);
    std::string part;
    while (std::getline(stream, part, separator)) {
        const std::optional<double> value = number_of(part);
        if (!value || std::abs(*value) > most) return {};
        values.push_back(*value);
    }
    if (values.size() != count || text.ends_with(separator)) values.clear();
    return values;
}

/// Checks every number of the command line: finite, and from `lo` to `hi`, which the help calls `name`.
CLI::Validator number_in(double lo, double hi, const std::string& name = {}) {
    return CLI::Validator(
        [lo, hi](std::string& text) -> std::string {
            const std::optional<double> value = number_of(text);
            if (value && *value >= lo && *value <= hi) return {};
            return fmt::format("'{}' is not a number from {:g} to {:g}", excerpt(text), lo, hi);
        },
        name.empty() ? fmt::format("{:g} to {:g}", lo, hi) : name);
}

void add_common(CLI::App* app, Common& c) {
    app->add_option("--threads", c.threads, "threads to use (0: one per core)")->check(number_in(0, 1024));
    app->add_flag("--json", c.json, "print one JSON object on standard output");
    app->add_flag("--quiet", c.quiet, "no progress, no notes");
}

void add_store(CLI::App* app, Surface& s) {
    app->add_option("--texel-store", s.texel_store,
                    "how texels are kept in memory: float, packed (16 bits, half the memory), "
                    "auto (packed beyond 4096)")
        ->check(CLI::IsMember({"auto", "float", "packed"}));
}

void add_frame(CLI::App* app, std::string& unit, std::string& up, const std::string& what) {
    app->add_option("--unit", unit, what)->check(CLI::IsMember({"um", "mm", "cm", "m", "in", "ft"}));
    app->add_option("--up", up,
                    "axis of the model file that points up: z, or y, as many modellers write it; points "
                    "on the command line are with z up: (x, y, z) of a file with y up is (x, -z, y)")
        ->check(CLI::IsMember({"z", "y"}));
}

void add_surface(CLI::App* app, Surface& s) {
    add_frame(app, s.unit, s.up, "unit of the model file (default: a guess from its size)");
    app->add_option("--atlas-size", s.atlas_size, "texels along the side of the atlas")
        ->check(number_in(1, kMostTexels, "POSITIVE"));
    app->add_option("--texel-size", s.texel_size_mm, "size of a texel in millimetres")
        ->check(number_in(kLeastTexelMm, kFarthestMm, "POSITIVE"));
    app->add_option("--pages", s.pages,
                    "most pages of the atlas (UDIM), each --atlas-size texels wide: as many as "
                    "--texel-size needs, or all of them")
        ->check(number_in(1, 100));
    app->parse_complete_callback([&s] {
        if (s.atlas_size > 0 && s.texel_size_mm > 0 && s.pages <= 1)
            throw CLI::ExcludesError("--atlas-size", "--texel-size (without --pages)");
    });
    auto* renew = app->add_flag("--new-uv", s.new_uv, "make a new atlas even if the file has UVs");
    auto* keep = app->add_flag("--keep-uv", s.keep_uv, "use the file's UVs or fail");
    renew->excludes(keep);
    auto* tight = app->add_flag("--tight", s.tight,
                                "halve large charts as long as the atlas is covered better then "
                                "(else: only where less than 65 % would be)");
    app->add_flag("--whole", s.whole, "never halve charts for the sake of the atlas")->excludes(tight);
    app->add_option("--seams", s.seams, "where the atlas must be cut: free, groups (of faces), sharp (edges), both")
        ->check(CLI::IsMember({"free", "groups", "sharp", "both"}))
        ->excludes(keep);
    app->add_option("--sharp-angle", s.sharp_angle_deg, "degrees from which an edge is sharp")
        ->check(number_in(1.0, 180.0));
    app->add_flag(
        "--plain", s.plain,
        "leave aside the colours that the model brings along (pictures, vertices, facets); else ink lies on them");
    add_store(app, s);
}

CLI::Option* add_point(CLI::App* app, const std::string& name, std::vector<double>& to, const std::string& what) {
    return app
        ->add_option_function<std::string>(
            name,
            [&to, name](const std::string& text) {
                to = numbers(text, ',', 3, kFarthestMm);
                if (to.empty())
                    throw CLI::ValidationError(
                        name, "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
            },
            what)
        ->type_name("X,Y,Z");
}

void add_layers(CLI::App* app, std::vector<std::string>& layers) {
    app->add_option("--layers", layers, "show these layers only, hidden ones too: NAME,...")->delimiter(',');
}

void add_recolouring(CLI::App* app, Recolouring& recolouring) {
    app->add_option("--substrate", recolouring.substrate,
                    "show the ink on this substrate (name or .toml), without painting it anew");
    app->add_option("--recolour", recolouring.recolours,
                    "show what was painted with INK as another ink or recipe: INK=NAME, INK=FILE.toml or INK=#rrggbb")
        ->type_name("INK=NAME");
}

void add_view_direction(CLI::App* app, View& v) {
    app->add_option_function<std::string>(
           "--view",
           [&v](const std::string& text) {
               const auto n = numbers(text, ',', 2, kMostDegrees);
               if (n.empty())
                   throw CLI::ValidationError("--view", "'" + excerpt(text) + "' is not AZIMUTH,ELEVATION in degrees");
               v.azimuth = n[0];
               v.elevation = n[1];
               v.directed = true;
           },
           "where to look from, in degrees: AZIMUTH,ELEVATION")
        ->type_name("AZ,EL");
}

void add_view(CLI::App* app, View& v) {
    app->add_option_function<std::string>(
           "--size",
           [&v](const std::string& text) {
               const auto n = numbers(text, 'x', 2, 16384);
               if (n.empty() || n[0] < 16 || n[1] < 16 || n[0] != std::floor(n[0]) || n[1] != std::floor(n[1]))
                   throw CLI::ValidationError("--size",
                                              "'" + excerpt(text) + "' is not WIDTHxHEIGHT, such as 1280x720");
               v.width = static_cast<int>(n[0]);
               v.height = static_cast<int>(n[1]);
           },
           "size of the picture, WIDTHxHEIGHT")
        ->type_name("WxH");
    add_layers(app, v.layers);
    add_view_direction(app, v);
    app->add_option("--light", v.light, "turn the lights by so many degrees (they follow the camera)")
        ->check(number_in(-kMostDegrees, kMostDegrees, "DEGREES"));
    app->add_flag("--raking", v.raking,
                  "one lamp from the side, which shows the relief of the ink; --light turns it about the view");
    app->add_option("--zoom", v.zoom, "magnification (1: the whole model)")->check(number_in(0.05, 100.0));
    app->add_option_function<std::string>(
           "--target",
           [&v](const std::string& text) {
               v.target_mm = numbers(text, ',', 3, kFarthestMm);
               if (v.target_mm.empty())
                   throw CLI::ValidationError("--target",
                                              "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
           },
           "the point to look at, in millimetres: X,Y,Z")
        ->type_name("X,Y,Z");
}

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
    p->add_option("--brush", paint.brush,
                  "brush for all strokes ('tuft brush' lists them; goat-small*0.5 is one of half the size; default: "
                  "what they name, else wolf-medium)");
    p->add_option("--ink", paint.ink,
                  "ink for all strokes: a name ('tuft ink' lists them), a .toml file, or a colour such as '#c03020' "
                  "(default: what they name, else carbon)");
    p->add_option("--mask", paint.mask, "mask of the project to keep to, for strokes that name none");
    p->add_flag_callback(
        "--erase", [&paint] { paint.erases = true; },
        "the strokes take ink away, wet and dry, instead of leaving some");
    p->add_option("--layer", paint.layer, "layer for strokes that name none; it is made when there is none yet");
    p->add_option("--substrate", paint.surface.substrate, "what the model is made of: porcelain, bisque, clay, ...");
    p->add_option("--spine", paint.spine,
                  "how the tuft bends: rod (live solve; as the brush says), table (query table), or a model of the "
                  "papers: macro "
                  "(hair macros), chain (kinematic chain), truss (spring truss)")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(brush::kSpineWords), std::end(brush::kSpineWords))));
    p->add_option("--footprint", paint.footprint, "footprint along the surface, or on one plane")
        ->check(CLI::IsMember({"surface", "plane"}));
    p->add_option("--contact", paint.contact, "exact closest points, or weighted distance to vertices")
        ->check(CLI::IsMember({"exact", "vertices"}));
    p->add_option(
         "--dip", paint.dip,
         "each: a fresh full brush for each stroke; persistent: hair and ink stay as the stroke before left them, "
         "until the next dip; endless: a brush that never runs dry")
        ->transform(CLI::Validator(
            [](std::string& word) {
                if (word == "carry") word = "persistent";  // of earlier versions
                return std::string();
            },
            ""))
        ->check(CLI::IsMember({"each", "persistent", "endless"}));
    p->add_option("--film", paint.film,
                  "still: ink stays where it is put; wet: it flows, soaks in, dries and is picked up")
        ->check(CLI::IsMember({"still", "wet"}));
    p->add_option_function<std::string>(
         "--down",
         [&paint](const std::string& text) {
             paint.down = numbers(text, ',', 3, kFarthestMm);
             if (paint.down.empty()) throw CLI::ValidationError("--down", "'" + excerpt(text) + "' is not X,Y,Z");
         },
         "direction of weight for wet ink (0,0,0: none)")
        ->type_name("X,Y,Z");
    p->add_option("--dry", paint.dry, "let the ink dry for so many seconds after each stroke file; 0: until all is dry")
        ->check(number_in(0.0, 86400.0))
        ->type_name("SECONDS");
    p->add_option(
         "--prepare", paint.prepare,
         "done with the full brush before it paints, in this order: rinse, wipe[,amount=0.6][,depth=0.3], "
         "dip[:INK][,depth=0.2][,amount=0.5], reshape; side=0.5 of a dip or wipe: only this part of the "
         "width, from the right flank, negative from the left; time=0.3 of a dip: seconds in the dish, in which "
         "ink rises in the hair")
        ->check([](const std::string& text) -> std::string {
            try {
                stroke::preparation_of(text);
                return {};
            } catch (const Error& e) {
                return e.what();
            }
        })
        ->type_name("CARE");
    p->add_option("--pressure", paint.pressure,
                  "pressure for flat strokes that have none: none, speed, dwell or speed+dwell")
        ->check(CLI::IsMember({"none", "speed", "dwell", "speed+dwell"}));
    p->add_option("--smooth", paint.smooth, "steady a shaky hand: 1 takes the jitter of a mouse away, 0 is off")
        ->check(number_in(0.0, 100.0));
    p->add_option("--stabilise", paint.stabilise_mm, "pull the tip on a string of so many millimetres")
        ->check(number_in(0.0, 1000.0))
        ->type_name("MM");
    p->add_option("--roll", paint.roll_deg,
                  "turn the holder about its own axis, anticlockwise as seen from its end; at 0 a wide ferrule lies "
                  "along the width of flat strokes")
        ->check(number_in(-360.0, 360.0))
        ->type_name("DEG");
    p->add_flag("--roll-follow", paint.roll_follow,
                "turn the broad side of the ferrule across the path as flat strokes go on; --roll is added");
    p->add_option("--bias,--habit", paint.bias, "correct a writer's bias (.toml, made by 'tuft bias')");
    p->add_option_function<std::string>(
         "--place",
         [&paint](const std::string& text) {
             paint.place_mm = numbers(text, ',', 3, kFarthestMm);
             if (paint.place_mm.empty())
                 throw CLI::ValidationError("--place",
                                            "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
         },
         "where flat strokes go that have no place of their own: X,Y,Z in millimetres")
        ->type_name("X,Y,Z");
    p->add_option("--on", paint.on,
                  "puts flat strokes onto the largest calm area of a side, as by default onto the "
                  "front or what lies flat: "
                  "front (-y), back, left (-x), right, top, bottom, inside (of what is open above)")
        ->check(CLI::IsMember({"front", "back", "left", "right", "top", "bottom", "inside"}))
        ->excludes("--place")
        ->type_name("SIDE");
    p->add_option_function<std::string>(
         "--read-from",
         [&paint](const std::string& text) {
             const auto side = stroke::side_named(text);
             if (side && *side != stroke::Side::inside) {
                 const Vec3 from = -stroke::look_at_side(*side);
                 paint.read_from = {from.x, from.y, from.z};
                 return;
             }
             paint.read_from = numbers(text, ',', 3, 1e9);
             if (paint.read_from.empty() ||
                 std::hypot(paint.read_from[0], paint.read_from[1], paint.read_from[2]) < 1e-6)
                 throw CLI::ValidationError("--read-from", "'" + text +
                                                               "' is neither front, back, left, right, top or "
                                                               "bottom nor a direction X,Y,Z");
         },
         "where a person stands who reads the drawing: front, back, left, right, top, bottom, or a "
         "direction X,Y,Z from the model; "
         "it stands upright for them, and --mapping project goes straight away from them (default: "
         "before the surface)")
        ->type_name("DIRECTION");
    p->add_option("--mapping,--laying", paint.mapping,
                  "how flat strokes lie: drape (bent round the surface, over its grooves, relief and gaps), wrap "
                  "(round its very "
                  "triangles, into each groove), project (straight, as seen from before the place); default: as their "
                  "file says, "
                  "drape where it names no place")
        ->check(CLI::IsMember({"drape", "wrap", "project"}));
    p->add_option("--place-width", paint.place_width_mm,
                  "draws what is placed this wide, all stroke files together (default: as written)")
        ->check(number_in(kLeastTexelMm, kFarthestMm, "POSITIVE"))
        ->type_name("MM");
    p->add_option("--place-turn", paint.place_turn_deg, "turns it anticlockwise by so many degrees")
        ->check(number_in(-360.0, 360.0))
        ->type_name("DEG");
    p->add_flag("--place-mirror", paint.place_mirror, "flips it from left to right");
    p->add_flag("--fit-brush", paint.fit_brush,
                "with --brush: takes this make in the sizes that draw the line widths of a drawing");
    add_surface(p, paint.surface);
    p->add_option("--project", paint.project, "write a project file (.tuft)");
    p->add_option("--export", paint.exported, "write the textured model: .glb, .gltf or .obj");
    p->add_option("--preview", paint.preview, "write a picture (.png)");
    p->add_option("--forces", paint.forces,
                  "write time, pose, force, force on the hand and moment at every sample of the hand (.csv)");
    add_view(p, paint.view);
    add_common(p, paint.common);

    Inspect inspect;
    auto* i = app.add_subcommand("inspect", "say what is in a mesh or a project, and what is wrong with it");
    i->add_option("FILE", inspect.file, "mesh or project")->required();
    add_frame(i, inspect.unit, inspect.up, "unit of the model file (default: a guess from its size)");
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
    add_frame(d, render.unit, render.up, "unit of a model file (default: a guess from its size)");
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
    else if (i->parsed())
        command = inspect;
    else if (u->parsed())
        command = unwrap;
    else if (r->parsed())
        command = replay;
    else if (e->parsed())
        command = exported;
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
    else
        command = bench;
    return true;
}

}  // namespace tuft::cli
