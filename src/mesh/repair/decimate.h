#pragma once

#include "mesh/read/polygon_soup.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Fewer triangles for a working copy of a large scan. `cli` calls it; strokes are painted on the copy and replayed on
/// the full model.
namespace tuft::mesh {

/// Goals of `decimate`.
struct DecimateOptions {
    std::size_t n_triangles = 0;  ///< most triangles that are wanted; 0: by `error` alone
    double error = 0;             ///< metres between both surfaces, about; 0: by `n_triangles` alone
};

/// Returns the mesh with edges collapsed in the order of their quadric error [Garland1997], by meshoptimizer. The
/// vertices that are left keep their places, colours and UVs. Borders, borders of groups and seams of UVs stay closed:
/// their edges collapse only along them. Collapsing ends at the first limit that is reached, or where no edge is left
/// that may collapse. Points are in metres; materials and parts are not kept. Throws `Error` when both limits are 0.
/// Cost: about 1 s and 0.3 GB for a million triangles.
/// A connected part wider than twice `error` stays, thin ones too. Where a number of triangles is wanted, the largest
/// of those that would go stay, within half of the triangles, but for one that needs more than that alone. What they
/// take is taken from the rest, which is collapsed anew, at most six times, as long as further parts go by that.
PolygonSoup decimate(const TriangleMesh& mesh, const DecimateOptions& options);

}  // namespace tuft::mesh
