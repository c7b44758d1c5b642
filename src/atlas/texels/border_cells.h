#pragma once

#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// How the texels of two charts share the surface along a seam.
namespace tuft::atlas {

/// Two texels that share a face. `conductance` = its length over their distance, 1 for two
/// texels side by side inside an even chart.
struct BorderFace {
    TexelRef a, b;  ///< a before b by slot, then texel
    double conductance = 0;
    double distance = 0;  ///< texels
    bool over_seam = false;
};

struct BorderCell {
    TexelRef texel;
    double area = 0;  ///< m²
};

/// Part of what stands where a texel's own chart has no neighbour any more: Σ weight w(other) is what lies one texel
/// to its `side` (0 right, 1 above, 2 left, 3 below), exact for linear w.
struct BorderTap {
    TexelRef texel, other;
    std::uint8_t side = 0;
    double weight = 0;
    bool over_seam = false;  ///< else `other` is the texel itself or one of the eight round it
};

struct BorderCells {
    std::vector<BorderTap> taps;    ///< by texel, then side
    std::vector<BorderCell> cells;  ///< of all texels with a neighbour over a seam; by slot, then texel
    std::vector<BorderFace> faces;  ///< between any two of them; by a, then b
};

/// Voronoi cells of the centres of the texels beside seams, among the texels of their own chart and those over the
/// seams, which are unrolled about the seam: the texels of both sides tile the surface together, whole ones inside
/// their charts and cut ones along the seam. A face stands at right angles on the line between its texels, so that
/// flux = k · conductance · (w_a − w_b) is exact for linear w (Eymard, Gallouët and Herbin 2000, admissible
/// meshes). Beyond borders of the surface and more than one seam at once, texels are whole. The same bits for any
/// number of threads. `only_cells`: without taps and faces, in half of the memory.
BorderCells build_border_cells(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                               bool only_cells = false);

}  // namespace tuft::atlas
