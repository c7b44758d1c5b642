#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// The command line as plain data, one struct per command. Lengths are in millimetres and angles in degrees, as typed;
/// the commands convert them. Filled by `parse_arguments`, read by the commands.
namespace tuft::cli {

/// Returns the three numbers of an option as a vector; `v` has three.
inline Vec3 vector_of(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

/// How a model file is read. Empty: as the file states it, else the default.
struct FileReading {
    std::string unit;     ///< um … ft, of the numbers in the file
    std::string up;       ///< y or z
    std::string sides;    ///< as `mesh::open_sides_of`
    double chord_mm = 0;  ///< of CAD surfaces; 0: by the size
    std::string groups;   ///< of CAD files: bodies or faces
};

/// Options of all commands that read a model.
struct Surface : FileReading {
    std::uint32_t atlas_size = 0;  ///< texels per side; 0: from texel_size_mm, else the default
    double texel_size_mm = 0;      ///< 0: from atlas_size
    std::uint32_t pages = 0;       ///< most pages (UDIM); 0: the default
    bool new_uv = false, keep_uv = false;
    bool tight = false, whole = false;
    std::string seams = "free";  ///< free | groups | sharp | both
    double sharp_angle_deg = 40;
    std::string texel_store = "auto";  ///< auto | float | packed
    std::string substrate = "porcelain";
    bool plain = false;     ///< ignores the model's own colours
    bool no_cache = false;  ///< neither reads nor writes the user's cache
};

/// Options of all commands.
struct Common {
    int threads = 0;  ///< 0: one per core
    bool json = false;
    bool quiet = false;
};

/// Options of all commands that draw a picture.
struct View {
    std::vector<std::string> layers;  ///< names of the layers to draw; empty: the visible ones
    int width = 1280, height = 720;
    double azimuth = 30, elevation = 25;
    bool directed = false;  ///< azimuth or elevation was given
    double zoom = 1;
    double light = 0;               ///< degrees, rotation of the lights about z
    bool raking = false;            ///< grazing light from the side
    std::vector<double> target_mm;  ///< [3], or empty: the middle of the model
};

/// States of parts: names of the mesh's groups.
struct PartChoice {
    std::vector<std::string> hide, only, lock;
    std::vector<std::string> substrates;  ///< PART=NAME
};

/// What strokes are painted with, and by which models of brush and contact.
struct StrokeChoice {
    std::string brush, ink;             ///< empty: the stroke file's, else the default
    std::string layer;                  ///< name; empty: the stroke file's, else the first one
    std::string mask;                   ///< name; empty: the stroke file's, else none
    bool erases = false;                ///< all strokes erase
    std::string spine = "rod";          ///< a word of brush::kSpineWords
    std::string footprint = "surface";  ///< surface | plane
    std::string contact = "exact";      ///< exact | vertices
    std::string dip = "each";           ///< each | persistent | endless
    std::vector<std::string> prepare;   ///< actions on the full brush before each stroke; see stroke::preparation_of
};

/// Whether ink flows, and when it dries.
struct WetInk {
    std::string film = "still";          ///< still | wet
    std::vector<double> down{0, 0, -1};  ///< [3] direction of gravity on wet ink, model frame
    double dry = -1;                     ///< seconds of drying after each stroke file; 0: until dry; < 0: none
};

/// Correction of the hand, and roll of the holder.
struct HandChoice {
    std::string pressure = "none";  ///< none | speed | dwell | speed+dwell, for strokes without pressure
    double smooth = 0;              ///< strength of the hand's filter; 0: off
    double stabilise_mm = 0;        ///< length of the stabiliser's string; 0: off
    double roll_deg = 0;            ///< roll of the holder, added to that of flat strokes
    bool roll_follow = false;       ///< the broad side of a ferrule turns across the path of flat strokes
    std::filesystem::path bias;     ///< file of the writer's bias to correct, or empty
    bool as_pointer = false;        ///< flat strokes of a hand are painted as by the pointer of the studio
    double pixel_mm = 0.1;          ///< at the model, of that pointer
};

/// Where flat strokes go, and how they lie there.
struct PlaceChoice {
    std::vector<double> at_mm;      ///< [3] position, or empty
    std::string on;                 ///< side of the model (stroke::side_name), or empty
    std::vector<double> read_from;  ///< [3] direction towards the reader of a drawing, or empty
    std::string snap;               ///< x, y or z: the place lies in the model's middle plane across it; or empty
    double width_mm = 0;            ///< width of the whole drawing; 0: as in the file
    std::string mapping;            ///< drape, wrap, project; empty: see place_strokes
    double turn_deg = 0;            ///< anticlockwise, seen from outside the surface
    bool mirror = false;            ///< mirrors the drawing from left to right
    std::string edges;              ///< facing, cut, run-over, end-before, wrap; empty: facing
    double edge_margin_mm = 2;      ///< of end-before
};

/// How a drawing becomes strokes and areas.
struct DrawingChoice {
    std::string areas;              ///< mask, brush; empty: by the drawing's colours
    double wide_lines_mm = 1.5;     ///< as painted; lines of a drawing in one ink are areas from this width on
    std::vector<std::string> only;  ///< layers and named groups of drawings; empty: all
    bool auto_texel = false;        ///< texels as small as the drawing's detail needs
    bool fit_brush = false;         ///< scales the brush to the line widths of a drawing
};

/// Copies of a drawing.
struct CopyChoice {
    std::string along;              ///< "rim", "edge" or a stroke file: path of copies; empty: none
    std::string repeat = "fit";     ///< fit, or a number of copies along it
    std::string mirror;             ///< some of x, y, z: planes of copies
    bool readable = false;          ///< mirrored copies keep text and marked groups readable
    int radial = 1;                 ///< copies round an axis, with the original
    std::string radial_axis = "z";  ///< x | y | z
};

/// Files that a painting is written to; empty: not written.
struct PaintOutput {
    std::filesystem::path project;   ///< .tuft
    std::filesystem::path exported;  ///< .glb, .gltf, .obj
    std::filesystem::path preview;   ///< .png
    std::filesystem::path forces;    ///< .csv
};

/// `tuft paint MODEL STROKES...`
struct Paint {
    std::filesystem::path model;
    std::vector<std::filesystem::path> strokes;
    StrokeChoice stroke;
    WetInk wet;
    HandChoice hand;
    PlaceChoice place;
    DrawingChoice drawing;
    CopyChoice copies;
    Surface surface;
    PartChoice parts;
    PaintOutput output;
    View view;
    Common common;
};

/// `tuft inspect FILE`
struct Inspect : FileReading {
    std::filesystem::path file;
    std::vector<double> at_mm;       ///< [3] point of a project, or empty
    std::filesystem::path save_ink;  ///< ink preset to write with the mixture at that point, or empty
    bool palette = false;            ///< `at_mm` is on the palette
    Common common;
};

/// `tuft unwrap MODEL -o OUTPUT`
struct Unwrap {
    std::filesystem::path model, output, picture;
    Surface surface;
    Common common;
};

/// `tuft decimate MODEL -o OUTPUT`
struct Decimate : FileReading {
    std::filesystem::path model, output;
    std::size_t triangles = 0;  ///< most triangles; 0: by error_mm alone
    double error_mm = 0;        ///< 0: by triangles alone
    Common common;
};

/// Options that change how a painting is shown, not how it was painted.
struct Recolouring {
    std::string substrate;               ///< name or .toml file; empty: the project's
    std::vector<std::string> recolours;  ///< INK=NAME or INK=FILE.toml
};

/// `tuft replay PROJECT`
struct Replay {
    std::filesystem::path project, model, out_project, exported, preview, moved;
    std::string brush, ink;
    std::string follow = "parts";  ///< "parts", "stretch" or "none"
    bool pull_back = false;
    Recolouring recolouring;
    Surface surface;
    View view;
    Common common;
};

/// `tuft export PROJECT`
struct Export {
    std::filesystem::path project, output;
    std::vector<std::string> layers;  ///< as in `View`
    int bits = 8;                     ///< per channel of base-colour.png, 8 or 16
    std::string map;                  ///< to write as a picture; empty: by the file's name, else base-colour
    std::string filaments;            ///< .3mf: colours or a .toml file; empty: a texture
    double wall_mm = 0.45, detail_mm = 0.5;
    std::string colour_space;  ///< srgb | display-p3 | acescg; empty: sRGB without a profile
    Recolouring recolouring;
    Common common;
};

/// `tuft layer PROJECT WHAT NAME [VALUE]`
struct LayerWork {
    std::filesystem::path project;
    std::string what, name, value;
    Common common;
};

/// `tuft part PROJECT WHAT [NAME...]`
struct PartWork {
    std::filesystem::path project;
    std::string what = "list";
    std::vector<std::string> names;
    Common common;
};

/// `tuft fill PROJECT`
struct FillWork {
    std::filesystem::path project;
    std::string ink = "carbon", to_ink, layer, mask;
    double film = -1, to_film = -1;                         ///< film units; < 0: the film that a full brush leaves
    std::vector<double> from_mm, to_mm, part_mm, chart_mm;  ///< [3] each, or empty
    bool round = false;
    bool palette = false;  ///< pours onto the palette, not onto the model
    Common common;
};

/// Polygon on a view of the model.
struct LassoChoice {
    std::string points;  ///< "X,Y X,Y ...", mm, as seen from `view`; empty: none
    View view;
    bool through = false;  ///< takes what faces away or is hidden too
};

/// `tuft mask PROJECT NAME`
struct MaskWork {
    std::filesystem::path project;
    std::string name;
    std::vector<std::string> groups, intersect, unite;
    std::string invert;
    std::vector<double> direction, chart_mm;  ///< [3] each, or empty
    double within = 45, soft = 0;             ///< degrees, angle of the normal to `direction`, and its soft range
    double clear_mm = 0;                      ///< distance to sharp edges; 0: none
    LassoChoice lasso;
    bool remove = false;
    Common common;
};

/// `tuft render FILE -o OUTPUT`
struct Render : FileReading {
    std::filesystem::path file, output;
    int turntable = 0;     ///< number of pictures round the model; 0: one picture
    std::string material;  ///< empty: the project's substrate, else porcelain
    Recolouring recolouring;
    View view;
    Common common;
};

/// `tuft film PROJECT -o OUTPUT`
struct Film {
    std::filesystem::path output;
    Replay replay;  ///< project, and what is painted otherwise than in it; its outputs are not used
    double seconds = 20;
    double speed = 0;  ///< times as fast as the hand; 0: as fast as `seconds` needs
    double frames_per_second = 25;
    double still_seconds = 2;      ///< of the finished work at the end
    std::string camera = "still";  ///< still | turntable | VIEW,VIEW,... | FILE.toml
    bool no_brush = false;
    std::vector<std::string> given;  ///< names and values of all options that change its frames
    Common common;
};

/// `tuft brush NAME`
struct Brush {
    std::string name;
    std::filesystem::path picture, sweep_depth;
    std::filesystem::path compare;            ///< measured table that all spine methods stand beside
    std::filesystem::path calibrate, output;  ///< `tuft brush calibrate MEASURED.csv -o BRUSH.toml`
    std::filesystem::path match;              ///< `tuft brush match MEASURED.csv`
    Common common;
};

/// `tuft bias INTENDED.inkml WRITTEN.inkml -o BIAS.toml`
struct BiasCorrection {
    std::filesystem::path intended, written, output;
    Common common;
};

/// `tuft ink`, `tuft ink match COLOUR`
struct InkWork {
    std::string colour;  ///< to match; empty: lists the inks
    std::string substrate = "porcelain";
    double film = 0;                    ///< film units; 0: as the colour needs
    int parts = 4;                      ///< most pigments in the mixture
    std::vector<std::string> pigments;  ///< names or .toml files to choose from; empty: all shipped
    std::filesystem::path output;
    Common common;
};

/// `tuft bench`
struct Bench {
    std::filesystem::path model;  ///< empty: models that the benchmark generates
    bool quick = false;
    std::vector<int> scaling;      ///< numbers of threads, to measure only how speed goes with them; empty: all figures
    double seconds = 90;           ///< within which runs over numbers of threads are repeated
    Surface surface;               ///< size 0: 4096, or 2048 when quick
    std::string isa = "best";      ///< best | avx512 | avx2 | baseline
    std::filesystem::path report;  ///< page to write, .html or .md; its figures go beside it as .json
    std::filesystem::path against;  ///< figures of an earlier report (.json); empty: those beside `report`
    Common common;
};

/// An arm: the one that a service speaks for, or a simulated one.
struct ArmChoice {
    std::string preset = "inverse3";  ///< of the arm that is spoken to or simulated
    std::string simulate;             ///< preset to simulate in this process; empty: the arm at `host`
    std::string host = "127.0.0.1";
    int port = 10001;  ///< 0 for a server: any free one
};

/// What a simulated arm and its hand do.
struct ArmSimulation {
    std::string motion = "circles";   ///< of the hand
    bool hands_off = false;           ///< nobody holds the arm
    std::string fault = "none";       ///< of the server, after `fault_after` seconds
    double fault_after = 3;           ///< seconds of a connection
    double delay_ms = 0;              ///< of a force on its way
    std::optional<double> jitter_ms;  ///< added to it, uniform; none: 0.5 where there is a delay
    std::filesystem::path follow;     ///< table of where the hand goes in place of a motion, or empty
};

/// What a hand feels besides hair.
struct ArmAdded {
    double proximity = 0;  ///< N on the hand, before the hair touches
    double paste = 0;      ///< Pa, yield stress of paste under the hair
};

/// What `tuft device test` tries beside its checks.
struct ArmTrial {
    int hands = 0;             ///< random hands
    int first_hand = 0;        ///< number of the first of them
    double hours = 0;          ///< simulated, one hand
    bool all_brushes = false;  ///< all shipped ones, not only `brush`
};

/// `tuft device list | simulate | test | record`
struct DeviceWork {
    std::string what;  ///< list | simulate | test | record
    ArmChoice arm;
    ArmSimulation simulation;
    ArmTrial trial;
    ArmAdded added;
    double seconds = 10;
    std::string brush = "wolf-medium";
    std::string spine = "rod";    ///< how the tuft bends; rod: as the brush says
    std::filesystem::path model;  ///< empty: the shipped bowl
    bool restore = false;         ///< the coupling's softness is taken away at rest
    std::filesystem::path output;
    std::filesystem::path replay;  ///< recording to play in place of an arm, or empty
    Common common;
};

/// `tuft write MODEL --text TEXT`
struct Write : Paint {
    std::string text;
    std::filesystem::path glyphs;          ///< source of strokes before the bundled ones, or empty
    std::filesystem::path like;            ///< picture of a character to copy, or empty
    std::string order;                     ///< of the copy's strokes (`writer::parse_order`); empty: by rules
    std::string cuts;                      ///< of the copy's pieces (`writer::parse_cuts`); empty: none
    double threshold = 0;                  ///< of the copy's ink (`writer::picture_ink`)
    std::filesystem::path numbered;        ///< drawing of the copy's pieces to write, .svg, or empty
    std::string style = "kaishu";          ///< name or .toml
    bool fit = false;                      ///< to the source's outlines
    double size_mm = 0;                    ///< side of a character's square; 0: as the place allows
    std::string direction = "horizontal";  ///< horizontal | vertical | rim | curve
    std::filesystem::path curve;           ///< stroke file whose first line the text runs along, or empty
    double spacing = 0, line_spacing = 0;  ///< 0: the style's
};

inline constexpr double kLeastPageMm = 60;  ///< side of a sheet

/// Sheets of film as they are printed.
struct PrintChoice {
    Vec2 page_mm{210, 297};             ///< height 0: a roll
    std::string grain = "free";         ///< free | up
    double dpi = 300;                   ///< dots per inch
    bool plates = false;                ///< a separation for each pigment
    bool outlines = false;              ///< areas of one ink as paths instead of pictures
    bool strain_map = false;            ///< pages that show the strain of the film
    std::string colour_space = "srgb";  ///< srgb | display-p3
};

/// `tuft decals PROJECT -o OUTPUT`
struct Decals {
    std::filesystem::path project, output;
    std::filesystem::path guide;      ///< folder, or empty
    std::string mask;                 ///< name; empty: all that is painted
    std::vector<std::string> layers;  ///< as in `View`
    Recolouring recolouring;
    double max_strain = 0.03;        ///< up to which the film follows the surface
    double bleed_mm = 3;             ///< film beyond the paint
    double overlap_mm = 1;           ///< of two panels
    double join_mm = 10;             ///< islands of paint nearer than this share a piece
    double least_fragment_mm2 = 10;  ///< of paint; see decal::make_sheet
    double least_piece_mm2 = 0;      ///< likewise
    PrintChoice print;
    Common common;
};

/// `tuft trajectory PROJECT -o OUTPUT`
struct TrajectoryWork {
    std::filesystem::path project, output;
    std::vector<double> tool{0, 0, 100, 0, 0, 0};  ///< [6] mm and degrees about x, y, z: TCP in the flange frame
    std::vector<double> base{0, 0, 0, 0, 0, 0};    ///< [6] the model in the robot's base frame
    std::vector<double> holder_mm{12, 150};        ///< [2] diameter and length
    double max_speed_mm = 250, max_acceleration_mm = 1000, max_turn_deg = 90;
    double clearance_mm = 20;
    Common common;
};

/// `tuft variants PLAN`
struct VariantsWork {
    std::filesystem::path plan;    ///< .toml file, or a folder of tasks
    std::filesystem::path output;  ///< folder of the tasks, of a plan
    bool run = false, gather = false;
    Common common;  ///< threads: workers
};

/// `tuft run-task FOLDER INDEX`
struct RunTask {
    std::filesystem::path folder;
    int index = -1;  ///< < 0: none
    int count = 1;
    bool rest = false;  ///< all open tasks that no other process has
    Common common;
};

using Command = std::variant<Paint, Write, Inspect, Unwrap, Decimate, Replay, Export, Render, Brush, BiasCorrection,
                             Bench, LayerWork, PartWork, FillWork, MaskWork, InkWork, DeviceWork, Decals,
                             TrajectoryWork, Film, VariantsWork, RunTask>;

/// Parses the command line into `command`. Returns false, with the exit status in `status`, when there is nothing to
/// run: after printing help or version (0), and after one line on standard error for a wrong command line (2). Main
/// thread.
bool parse_arguments(int argc, const char* const* argv, Command& command, int& status);

}  // namespace tuft::cli
