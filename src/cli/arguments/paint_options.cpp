#include <fmt/format.h>

#include <cmath>

#include "brush/preset/preset.h"
#include "cli/arguments/drawing_arguments.h"
#include "cli/arguments/options.h"
#include "core/error.h"
#include "core/text/text.h"
#include "stroke/drawing/free_area.h"
#include "stroke/journal/recorded_stroke.h"
#include "writer/layout/text_layout.h"

namespace tuft::cli {

namespace {

/// Takes a value of --substrate: NAME is the whole model's, PART=NAME a part's.
void take_substrate(Paint& paint, const std::string& value) {
    if (value.find('=') == std::string::npos)
        paint.surface.substrate = value;
    else
        paint.parts.substrates.push_back(value);
}

/// Brush, ink, layer, mask and substrate.
void add_materials(CLI::App* p, Paint& paint) {
    p->add_option("--brush", paint.stroke.brush,
                  "brush for all strokes ('tuft brush' lists them; goat-small*0.5 is one of half the size; default: "
                  "what they name, else wolf-medium)");
    p->add_option("--ink", paint.stroke.ink,
                  "ink for all strokes: a name ('tuft ink' lists them), a .toml file, or a colour such as '#c03020'; "
                  "dips that a file records keep their own inks "
                  "(default: what they name, else carbon)");
    p->add_option("--mask", paint.stroke.mask, "mask of the project to keep to, for strokes that name none");
    p->add_flag_callback(
        "--erase", [&paint] { paint.stroke.erases = true; },
        "the strokes take ink away, wet and dry, instead of leaving some");
    p->add_option("--layer", paint.stroke.layer, "layer for strokes that name none; it is made when there is none yet");
    p->add_option_function<std::vector<std::string>>(
         "--substrate",
         [&paint](const std::vector<std::string>& values) {
             for (const std::string& value : values) take_substrate(paint, value);
         },
         "what the model is made of: porcelain, bisque, clay, ...; PART=NAME: what a part of it is made of, more by "
         "another --substrate")
        ->allow_extra_args(false);
    p->add_option("--hide-parts", paint.parts.hide,
                  "parts (groups of the model's file) that are as if they were not there: NAME,...")
        ->delimiter(',')
        ->allow_extra_args(false);
    p->add_option("--only-parts", paint.parts.only, "hide all parts but these: NAME,...")
        ->delimiter(',')
        ->allow_extra_args(false);
    p->add_option("--lock-parts", paint.parts.lock, "parts that are touched and get no ink: NAME,...")
        ->delimiter(',')
        ->allow_extra_args(false);
}

/// Models of tuft, footprint and contact.
void add_models(CLI::App* p, Paint& paint) {
    p->add_option("--spine", paint.stroke.spine,
                  "how the tuft bends: rod (live solve; as the brush says), table (query table), or a model of the "
                  "papers: macro "
                  "(hair macros), chain (kinematic chain), truss (spring truss)")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(brush::kSpineWords), std::end(brush::kSpineWords))));
    p->add_option("--footprint", paint.stroke.footprint, "footprint along the surface, or on one plane")
        ->check(CLI::IsMember({"surface", "plane"}));
    p->add_option("--contact", paint.stroke.contact, "exact closest points, or weighted distance to vertices")
        ->check(CLI::IsMember({"exact", "vertices"}));
}

/// What happens to the ink before, during and after strokes.
void add_ink_options(CLI::App* p, Paint& paint) {
    p->add_option(
         "--dip", paint.stroke.dip,
         "each: a fresh full brush for each stroke; persistent: hair and ink stay as the stroke before left them, "
         "until the next dip; endless: a brush that never runs dry")
        ->transform(CLI::Validator(
            [](std::string& word) {
                if (word == "carry") word = "persistent";  // of earlier versions
                return std::string();
            },
            ""))
        ->check(CLI::IsMember({"each", "persistent", "endless"}));
    p->add_option("--film", paint.wet.film,
                  "still: ink stays where it is put; wet: it flows, soaks in, dries and is picked up")
        ->check(CLI::IsMember({"still", "wet"}));
    p->add_option_function<std::string>(
         "--down",
         [&paint](const std::string& text) {
             paint.wet.down = numbers(text, ',', 3, kFarthestMm);
             if (paint.wet.down.empty()) throw CLI::ValidationError("--down", "'" + excerpt(text) + "' is not X,Y,Z");
         },
         "direction of weight for wet ink (0,0,0: none)")
        ->type_name("X,Y,Z");
    p->add_option("--dry", paint.wet.dry,
                  "let the ink dry for so many seconds after each stroke file; 0: until all is dry")
        ->check(number_in(0.0, 86400.0))
        ->type_name("SECONDS");
    p->add_option(
         "--prepare", paint.stroke.prepare,
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
        ->type_name("ACTION");
}

/// Filters of the hand and turn of the holder.
void add_hand_options(CLI::App* p, Paint& paint) {
    p->add_option("--pressure", paint.hand.pressure,
                  "pressure for flat strokes that have none: none, speed, dwell or speed+dwell")
        ->check(CLI::IsMember({"none", "speed", "dwell", "speed+dwell"}));
    p->add_option("--smooth", paint.hand.smooth, "steady a shaky hand: 1 takes the jitter of a mouse away, 0 is off")
        ->check(number_in(0.0, 100.0));
    p->add_option("--stabilise", paint.hand.stabilise_mm, "pull the tip on a string of so many millimetres")
        ->check(number_in(0.0, 1000.0))
        ->type_name("MM");
    p->add_option("--roll", paint.hand.roll_deg,
                  "turn the holder about its own axis, anticlockwise as seen from its end; at 0 a wide ferrule lies "
                  "along the width of flat strokes")
        ->check(number_in(-360.0, 360.0))
        ->type_name("DEG");
    p->add_flag("--roll-follow", paint.hand.roll_follow,
                "turn the broad side of the ferrule across the path as flat strokes go on; --roll is added");
    p->add_option("--bias,--habit", paint.hand.bias, "correct a writer's bias (.toml, made by 'tuft bias')");
}

}  // namespace

void add_pointer_options(CLI::App* p, Paint& paint) {
    CLI::Option* pointer = p->add_flag(
        "--as-pointer", paint.hand.as_pointer,
        "paint recorded strokes of a hand as the pointer of tuft-studio does: aimed at the model along their "
        "placement, "
        "sample by sample, over gaps and off at edges; the journal holds the poses; --smooth 1 steadies as it does");
    p->add_option("--pixel", paint.hand.pixel_mm, "size of that pointer's pixel on the model")
        ->check(number_in(1e-6, 1e4))
        ->type_name("MM")
        ->needs(pointer);
}

namespace {

/// Where flat strokes go.
void add_place_options(CLI::App* p, Paint& paint) {
    p->add_option_function<std::string>(
         "--place",
         [&paint](const std::string& text) {
             paint.place.at_mm = numbers(text, ',', 3, kFarthestMm);
             if (paint.place.at_mm.empty())
                 throw CLI::ValidationError("--place",
                                            "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
         },
         "where flat strokes go that have no place of their own: X,Y,Z in millimetres")
        ->type_name("X,Y,Z");
    p->add_option("--on", paint.place.on,
                  "puts flat strokes onto the largest calm area of a side, as by default onto the "
                  "front or what lies flat: "
                  "front (-y), back, left (-x), right, top, bottom, inside (of what is open above)")
        ->check(CLI::IsMember({"front", "back", "left", "right", "top", "bottom", "inside"}))
        ->excludes("--place")
        ->type_name("SIDE");
}

/// From where a drawing is read.
void add_reader(CLI::App* p, Paint& paint) {
    p->add_option_function<std::string>(
         "--read-from",
         [&paint](const std::string& text) {
             const auto side = stroke::side_named(text);
             if (side && *side != stroke::Side::inside) {
                 const Vec3 from = -stroke::look_at_side(*side);
                 paint.place.read_from = {from.x, from.y, from.z};
                 return;
             }
             paint.place.read_from = numbers(text, ',', 3, 1e9);
             if (paint.place.read_from.empty() ||
                 std::hypot(paint.place.read_from[0], paint.place.read_from[1], paint.place.read_from[2]) < 1e-6)
                 throw CLI::ValidationError("--read-from", "'" + text +
                                                               "' is neither front, back, left, right, top or "
                                                               "bottom nor a direction X,Y,Z");
         },
         "where a person stands who reads the drawing: front, back, left, right, top, bottom, or a "
         "direction X,Y,Z from the model; "
         "it stands upright for them, and --mapping project goes straight away from them (default: "
         "before the surface)")
        ->type_name("DIRECTION");
}

/// How flat strokes are mapped onto the surface.
void add_mapping(CLI::App* p, Paint& paint) {
    p->add_option(
         "--mapping,--laying", paint.place.mapping,
         "how flat strokes lie: drape (bent round the surface, over its grooves, relief and gaps), wrap (along "
         "its triangles, into each groove), project (straight, as seen from before the place); default: as "
         "their file says, drape where it names no place")
        ->check(CLI::IsMember({"drape", "wrap", "project"}));
    p->add_option("--place-width", paint.place.width_mm,
                  "draws what is placed this wide, all stroke files together (default: as written)")
        ->check(number_in(kLeastTexelMm, kFarthestMm, "POSITIVE"))
        ->type_name("MM");
    p->add_option(
         "--snap", paint.place.snap,
         "moves the middle of the drawing into the middle plane of the model across this axis, such as that of "
         "its symmetry")
        ->check(CLI::IsMember({"x", "y", "z"}));
    p->add_option("--place-turn", paint.place.turn_deg, "turns it anticlockwise by so many degrees")
        ->check(number_in(-360.0, 360.0))
        ->type_name("DEG");
    p->add_flag("--place-mirror", paint.place.mirror, "flips it from left to right");
}

/// Files that are written.
void add_outputs(CLI::App* p, Paint& paint) {
    p->add_option("--project", paint.output.project, "write a project file (.tuft)");
    p->add_option("-o,--export", paint.output.exported, "write the textured model: .glb, .gltf or .obj");
    p->add_option("--preview", paint.output.preview, "write a picture (.png)");
    p->add_option("--forces", paint.output.forces,
                  "write time, pose, force, force on the hand and moment at every sample of the hand (.csv)");
}

}  // namespace

void add_paint_options(CLI::App* p, Paint& paint) {
    add_materials(p, paint);
    add_models(p, paint);
    add_ink_options(p, paint);
    add_hand_options(p, paint);
    add_place_options(p, paint);
    add_reader(p, paint);
    add_mapping(p, paint);
    add_drawing_options(*p, paint);
    p->add_flag("--fit-brush", paint.drawing.fit_brush,
                "with --brush: takes this make in the sizes that draw the line widths of a drawing");
    add_surface(p, paint.surface);
    add_cache(p, paint.surface);
    add_outputs(p, paint);
    add_view(p, paint.view);
}

namespace {
constexpr double kMostPicture = 16384;  // pixels along a side

/// A character copied from a picture.
void add_copy_options(CLI::App* w, Write& write) {
    auto* like =
        w->add_option("--like", write.like,
                      "copy the character of a picture instead: a photo, a scan or a rubbing (--text: its name)");
    w->add_option("--order", write.order,
                  "strokes of the copy in the order of writing, as pieces of its centre line: \"1+2 -4 3\" joins 1 and "
                  "2, and writes 4 from its end (default: by rules, printed)")
        ->needs(like)
        ->type_name("LIST");
    w->add_option(
         "--cut", write.cuts,
         "cuts pieces of the copy before --order: \"3:0.45\" cuts piece 3 at 0.45 of its length; what is cut off is "
         "a new piece, numbered after the last one")
        ->needs(like)
        ->type_name("LIST");
    w->add_option("--threshold", write.threshold,
                  "of the copy's ink, from -0.9 (only the darkest) to 0.9; more makes lines thicker")
        ->needs(like)
        ->check(CLI::Range(-0.9, 0.9));
    w->add_option("--numbered", write.numbered, "write a drawing of the pieces of the copy, numbered: .svg")
        ->needs(like);
}

/// Takes a value of --size: a character's side in millimetres, or the size of a picture.
void take_size(Write& write, const std::string& text) {
    const auto picture = numbers(text, 'x', 2, kMostPicture);
    const auto side = number_of(text);
    if (picture.size() == 2 && picture[0] >= 16 && picture[1] >= 16) {
        write.view.width = static_cast<int>(picture[0]);
        write.view.height = static_cast<int>(picture[1]);
    } else if (side && *side >= kLeastTexelMm && *side <= kFarthestMm) {
        write.size_mm = *side;
    } else {
        throw CLI::ValidationError("--size", "'" + excerpt(text) +
                                                 "' is neither a character's side in millimetres nor the "
                                                 "size of a picture, such as 1280x720");
    }
}

}  // namespace

void add_write_options(CLI::App* w, Write& write) {
    w->add_option("--text", write.text, "what is written; \\n begins a line or a column")->type_name("TEXT");
    add_copy_options(w, write);
    w->add_option("--glyphs", write.glyphs,
                  "where the characters' strokes come from before the bundled ones: a folder of KanjiVG (SVG), of "
                  "hanzi-writer-data or Make Me a Hanzi (JSON), a single-line SVG font, a font file, or the name of an "
                  "installed font")
        ->type_name("FOLDER");
    w->add_option("--style", write.style,
                  "how they are written: kaishu (regular script), xingshu (running script), line (an even pen), italic "
                  "(a broad edge), or a .toml file")
        ->type_name("STYLE");
    w->add_flag("--fit", write.fit,
                "follow the outlines of the source, where it states them; characters of a font, else filled, become "
                "strokes of the brush (kaishu, xingshu), but for those too large or too intricate");
    w->add_option("--direction", write.direction,
                  "horizontal, vertical (columns from right to left), rim (level round the model, in the middle "
                  "--place) or curve (along --curve)")
        ->check(
            CLI::IsMember(std::vector<std::string>(writer::kDirectionNames.begin(), writer::kDirectionNames.end())));
    w->add_option("--curve", write.curve, "what the text runs along: the first line of a file (.inkml or .svg)");
    w->add_option("--spacing", write.spacing, "between characters, in parts of their width (default: the style's)")
        ->check(number_in(0.1, 10.0));
    w->add_option("--line-spacing", write.line_spacing, "between lines, in parts of the size (default: the style's)")
        ->check(number_in(0.1, 10.0));
    w->get_option("--brush")->description(
        "brush for all strokes ('tuft brush' lists them; default: the style's, in the size that suits the text)");
    for (const char* other : {"--along", "--repeat", "--size"}) w->remove_option(w->get_option(other));
    w->add_option_function<std::string>(
         "--size", [&write](const std::string& text) { take_size(write, text); },
         "side of a character's square in millimetres (default: as large as the place allows, or by --place-width); "
         "WIDTHxHEIGHT: size of the picture")
        ->type_name("MM|WxH")
        ->expected(1, 2)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace tuft::cli
