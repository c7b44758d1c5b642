#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/drawing/drawing.h"

/// A drawing or handwriting that waits to be placed on the model.
namespace tuft::app {

struct Writing {
    std::filesystem::path file;
    std::vector<stroke::Trace> traces;  ///< flat, metres, in the frame of the file
    std::vector<std::string> notes;     ///< what of the file is left out, one line each
    Vec2 centre{0};                     ///< metres, of the ink of all traces
    double width = 0, height = 0;       ///< metres, likewise, as in the file
    double scale = 1;
    double turn = 0;        ///< radians, clockwise as seen
    bool mirrored = false;  ///< flipped from left to right
    stroke::SurfaceMapping mapping = stroke::SurfaceMapping::drape;
    bool own_ink = false;   ///< brush and ink as the file names them
    bool own_width = true;  ///< lines as wide as the drawing has them, where it has widths

    bool empty() const { return traces.empty(); }
};

/// Reads an InkML or SVG file. Throws `Error` also when nothing in it is flat.
Writing read_writing(const std::filesystem::path& file);

/// The placement of its middle at a point of the surface, seen with `right` to the right; `normal`
/// points towards the eye, which is in the direction `eye` (unit) from there. Origin and turn are
/// those of `tuft paint --place --place-turn --read-from`, to 0.001 mm and 0.01°, so that
/// `place_words` give them exactly.
stroke::Placement place_writing(const Writing& writing, const mesh::SurfaceQuery& query, const Vec3& at,
                                const Vec3& normal, const Vec3& right, const Vec3& eye);

/// The scale at which it is painted: `writing.scale`, its width to 0.001 mm.
double painted_scale(const Writing& writing);

/// "--place 1.000,2.000,3.000 --place-width 60.000 --place-turn 5.00": the options of `tuft paint`
/// that place it so.
std::string place_words(const Writing& writing, const stroke::Placement& placement);

/// Whether its lines have widths.
bool has_widths(const Writing& writing);

/// What a person paints it with.
struct WritingHand {
    std::string brush, ink;  ///< presets; with `Writing::own_ink` of what names none
    double pressure = 1;     ///< factor of pressures that were made up, of lines without widths
};

/// Its traces as journal entries at the placement, without the brushes' sizes and their pressures,
/// which `stroke::choose_brushes` and `stroke::press_to_widths` find.
struct PlacedWriting {
    std::vector<stroke::Stroke> entries;
    double scale = 1;
    double extent = 0;  ///< metres, the larger side as painted
    stroke::BrushFit fit;
};
PlacedWriting placed_writing(const Writing& writing, const stroke::Placement& placement, const WritingHand& hand);

/// How it would lie: one line for each piece of a trace on the surface, with its normals, of at
/// most `most` samples in all.
struct GhostPoint {
    Vec3 position, normal;
    bool seen = true;  ///< nothing of the model lies before it
};
std::vector<std::vector<GhostPoint>> ghost_lines(const mesh::SurfaceQuery& query, const Writing& writing,
                                                 const stroke::Placement& placement, std::size_t most = 3000);

}  // namespace tuft::app
