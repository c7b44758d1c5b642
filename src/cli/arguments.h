#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/types.h"

/// What the command line asks for, as plain data. Lengths are in millimetres and
/// angles in degrees here; the commands convert.
namespace tuft::cli {

/// Of the three numbers of an option.
inline Vec3 vector_of(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

/// Options that several commands share.
struct Surface {
    std::string unit, up;          ///< of the model file; empty: the default, or as the project says
    std::uint32_t atlas_size = 0;  ///< texels per side; 0: from texel_size_mm or the default
    double texel_size_mm = 0;
    std::uint32_t pages = 0;  ///< most pages (UDIM); 0: not said
    bool new_uv = false, keep_uv = false;
    bool tight = false, whole = false;
    std::string seams = "free";  ///< free | groups | sharp | both
    double sharp_angle_deg = 40;
    std::string texel_store = "auto";  ///< auto | float | packed
    std::string substrate = "porcelain";
    bool plain = false;  ///< without the colours that the model brings along
};

struct Common {
    int threads = 0;  ///< 0: one per core
    bool json = false;
    bool quiet = false;
};

/// What to see of a painting, and from where.
struct View {
    std::vector<std::string> layers;  ///< names of those to be seen; empty: the visible ones
    int width = 1280, height = 720;
    double azimuth = 30, elevation = 25;
    bool directed = false;  ///< these two were asked for
    double zoom = 1;
    double light = 0;               ///< degrees the lights are turned about z
    bool raking = false;            ///< light from the side
    std::vector<double> target_mm;  ///< three numbers, or empty: the middle of the model
};

struct Paint {
    std::filesystem::path model;
    std::vector<std::filesystem::path> strokes;
    std::string brush, ink;              ///< empty: as the stroke file says, else the default
    std::string layer;                   ///< name; empty: as the stroke file says, else the first one
    std::string mask;                    ///< name; empty: as the stroke file says, else none
    bool erases = false;                 ///< all strokes take ink away
    std::string spine = "rod";           ///< rod | table
    std::string footprint = "surface";   ///< surface | plane
    std::string contact = "exact";       ///< exact | vertices
    std::string dip = "each";            ///< each | carry | endless
    std::string film = "still";          ///< still | wet
    std::vector<double> down{0, 0, -1};  ///< towards the ground, for wet ink
    double dry = -1;  ///< seconds that the ink dries after each stroke file; 0: until dry; < 0: not at all
    std::vector<std::string> prepare;  ///< what is done with a full brush first; see stroke::preparation_of
    std::string pressure = "none";     ///< none | speed | dwell | speed+dwell, for strokes without any
    double smooth = 0;                 ///< strength of the hand's filter; 0: off
    double stabilise_mm = 0;           ///< length of the string; 0: off
    double roll_deg = 0;               ///< of the holder about its own axis, added to what flat strokes say
    bool roll_follow = false;          ///< a ferrule's broad side turns across the path of flat strokes
    std::filesystem::path bias;        ///< bias to correct, or empty
    std::vector<double> place_mm;      ///< x,y,z of the placement for flat strokes, or empty
    std::string on;                    ///< side of the model (stroke::side_name) for flat strokes, or empty
    std::vector<double> read_from;     ///< direction of who reads the drawing, three numbers, or empty
    double place_width_mm = 0;         ///< of the whole drawing placed; 0: as written
    std::string mapping;               ///< drape, wrap, project; empty: see place_strokes
    double place_turn_deg = 0;         ///< anticlockwise, as seen by who stands before the surface
    bool place_mirror = false;         ///< flips the drawing from left to right
    bool fit_brush = false;            ///< `brush` in the sizes that the lines of a drawing need
    Surface surface;
    std::filesystem::path project, exported, preview, forces;
    View view;
    Common common;
};

struct Inspect {
    std::filesystem::path file;
    std::string unit, up;            ///< empty: guess; z
    std::vector<double> at_mm;       ///< of a project: three numbers, or empty
    std::filesystem::path save_ink;  ///< write what lies there as an ink, or empty
    bool palette = false;            ///< `at_mm` is a place of the palette
    Common common;
};

struct Unwrap {
    std::filesystem::path model, output, picture;
    Surface surface;
    Common common;
};

/// How painted work is shown, without painting it anew.
struct Recolouring {
    std::string substrate;               ///< name or .toml; empty: as it is
    std::vector<std::string> recolours;  ///< INK=NAME or INK=FILE.toml
};

struct Replay {
    std::filesystem::path project, model, out_project, exported, preview;
    std::string brush, ink;
    Recolouring recolouring;
    Surface surface;
    View view;
    Common common;
};

struct Export {
    std::filesystem::path project, output;
    std::vector<std::string> layers;  ///< as in `View`
    int bits = 8;                     ///< a channel of base-colour.png
    std::string map;                  ///< of a picture; empty: by the file's name, else base-colour
    Recolouring recolouring;
    Common common;
};

/// `tuft layer PROJECT WHAT NAME [VALUE]`
struct LayerWork {
    std::filesystem::path project;
    std::string what, name, value;
    Common common;
};

/// `tuft fill PROJECT`
struct FillWork {
    std::filesystem::path project;
    std::string ink = "carbon", to_ink, layer, mask;
    double film = -1, to_film = -1;                         ///< film units; < 0: what a full brush leaves of the ink
    std::vector<double> from_mm, to_mm, part_mm, chart_mm;  ///< three numbers, or empty
    bool round = false;
    bool palette = false;  ///< a pool on the palette, not on the model
    Common common;
};

/// `tuft mask PROJECT NAME`
struct MaskWork {
    std::filesystem::path project;
    std::string name;
    std::vector<std::string> groups, intersect, unite;
    std::string invert;
    std::vector<double> direction, chart_mm;  ///< three numbers, or empty
    double within = 45, soft = 0;
    std::string lasso;  ///< "X,Y X,Y ..." in mm as seen from `view`
    View view;
    bool through = false, remove = false;
    Common common;
};

struct Render {
    std::filesystem::path file, output;
    int turntable = 0;     ///< number of pictures; 0: one picture
    std::string unit, up;  ///< of a model file; empty: the default
    std::string material;  ///< empty: from the project's substrate, else porcelain
    Recolouring recolouring;
    View view;
    Common common;
};

struct Brush {
    std::string name;
    std::filesystem::path picture, sweep_depth;
    std::filesystem::path calibrate, output;  ///< `tuft brush calibrate MEASURED.csv -o BRUSH.toml`
    Common common;
};

/// `tuft bias INTENDED.inkml WRITTEN.inkml -o BIAS.toml`
struct BiasCorrection {
    std::filesystem::path intended, written, output;
    Common common;
};

/// `tuft ink`, `tuft ink match COLOUR`
struct InkWork {
    std::string colour;  ///< to be matched; empty: the inks are listed
    std::string substrate = "porcelain";
    double film = 0;                    ///< film units; 0: as many as the colour needs
    int parts = 4;                      ///< pigments in the mix, at most
    std::vector<std::string> pigments;  ///< names or .toml files to choose from; empty: all shipped ones
    std::filesystem::path output;
    Common common;
};

struct Bench {
    std::filesystem::path model;  ///< empty: models made by the benchmark
    bool quick = false;
    Surface surface{.atlas_size = 0};  ///< size 0: 4096, or 2048 when quick
    std::string isa = "best";          ///< best | avx512 | avx2 | baseline
    Common common;
};

using Command = std::variant<Paint, Inspect, Unwrap, Replay, Export, Render, Brush, BiasCorrection, Bench, LayerWork,
                             FillWork, MaskWork, InkWork>;

/// Reads the command line. Prints help or version and returns false with `status` set
/// when there is nothing to run; a wrong command line gives one line on standard error
/// and status 2.
bool parse_arguments(int argc, const char* const* argv, Command& command, int& status);

}  // namespace tuft::cli
