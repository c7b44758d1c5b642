#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/message.h"
#include "core/system/progress.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Repair: from a polygon soup to a clean triangle mesh. `io`, `stroke` and `cli` call it for every model they
/// load.
namespace tuft::mesh {

/// Which side of an open part is its front. Closed parts face outward always.
enum class OpenSides {
    outward,  ///< the side that sees far more of the open than the other, where there is one (`orient`); else the
              ///< file's
    file,     ///< the file's
    turned,   ///< the other one
};

/// Words of the command line: outward, file, turned. Back throws `Error` for any other word.
OpenSides open_sides_of(const std::string& name);

/// Options of `build_surface`.
struct RepairOptions {
    double metres_per_unit = 1e-3;                      ///< the file's unit; millimetres by default
    bool y_up = false;                                  ///< y is up in the file: points are rotated to (x, −z, y)
    double crease_angle = 40.0 * 0.017453292519943295;  ///< radians; normals split above it
    OpenSides sides = OpenSides::outward;
    ProgressFn progress = nullptr;
};

/// What a file holds.
struct FileCounts {
    std::size_t points = 0;
    std::size_t polygons = 0;
    std::size_t polygons_triangulated = 0;  ///< with more than three corners
    bool loose_triangles = false;           ///< every corner has its own point, as in STL
};

/// Places where the surface was no manifold, and was split.
struct NonManifoldCounts {
    std::size_t edges_split = 0;
    std::size_t vertices_split = 0;
};

/// Defects that were found and repaired. Counts are of the file's elements.
struct RepairReport {
    FileCounts file;
    std::size_t vertices_welded = 0;  ///< removed because they coincide with another
    /// Removed because they lie within 1e-6 of the size: border vertices of loose triangles.
    std::size_t crack_vertices_welded = 0;
    std::size_t unused_vertices_dropped = 0;
    std::size_t degenerate_faces_dropped = 0;   ///< repeated corner or zero area
    std::size_t degenerate_faces_repaired = 0;  ///< a corner on the opposite side: that side flipped
    std::size_t duplicate_faces_dropped = 0;
    NonManifoldCounts non_manifold;
    std::size_t faces_flipped = 0;  ///< to orient a component consistently, and a closed one outward
    std::size_t parts_turned = 0;   ///< open components that were inside out (`OpenSides::outward`)
    std::size_t components = 0;
    std::size_t holes = 0;  ///< border loops
    std::size_t border_edges = 0;
    bool closed = false;
    std::vector<Message> warnings;  ///< from the reader and from the repair, one line each
};

/// Result of `build_surface`.
struct Surface {
    TriangleMesh mesh;
    RepairReport report;
};

/// Welds, triangulates, drops, splits and orients the polygons of a soup. The result is a clean mesh as plain
/// arrays; OpenMesh stays inside. Normals of the soup are kept where they are within 60° of the triangle's own. Closed
/// components are oriented outward, open ones as `OpenSides` says. Deterministic. Throws `Error` only when no triangle
/// with an area is left. Cost: about 2 s and 0.5 GB per million triangles.
Surface build_surface(PolygonSoup soup, const RepairOptions& options = {});

}  // namespace tuft::mesh
