#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "mesh/surface_query.h"
#include "stroke/journal/trace.h"

/// A drawing or handwriting that waits to be laid onto the model.
namespace tuft::app {

struct Writing {
    std::filesystem::path file;
    std::vector<stroke::Trace> traces;   ///< flat, metres, (0, 0) in their middle
    double width = 0, height = 0;        ///< metres, as in the file
    double scale = 1;
    double turn = 0;                     ///< radians, clockwise as seen
    stroke::Laying laying = stroke::Laying::drape;
    bool own_ink = false;                ///< brush and ink as the file names them
    bool own_width = true;               ///< lines as wide as the drawing has them, where it has widths

    bool empty() const { return traces.empty(); }
};

/// Reads an InkML or SVG file. Throws `Error` also when nothing in it is flat.
Writing read_writing(const std::filesystem::path& file, const std::function<void(const std::string&)>& note = {});

/// Where it comes to lie with its middle at a point of the surface, seen with `right` to the right.
stroke::Placement place_writing(const Writing& writing, const mesh::SurfacePoint& at, const Vec3& normal, const Vec3& right);

/// Whether its lines have widths.
bool has_widths(const Writing& writing);

/// The traces as they will be painted, pressures that were made up times `pressure`. Widths of lines grow
/// with the rest; without `own_width` there are none.
std::vector<stroke::Trace> placed_traces(const Writing& writing, const stroke::Placement& placement, double pressure);

/// Takes the brush in the sizes that the line widths need, and presses so that they come out.
void draw_to_widths(std::vector<stroke::Trace>& traces);

/// How it would lie: one line for each piece of a trace on the surface, with its normals, of at
/// most `most` samples in all.
struct GhostPoint {
    Vec3 position, normal;
};
std::vector<std::vector<GhostPoint>> ghost_lines(const mesh::SurfaceQuery& query, const Writing& writing, const stroke::Placement& placement,
                                                 std::size_t most = 3000);

}  // namespace tuft::app
