#pragma once

#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// \file
/// Cells and faces of the texels beside chart seams, for conservative fluxes over seams. Called by texel_map.h and
/// seam_links.h.
namespace tuft::atlas {

/// Two texels that share a face. `conductance` is the face's length over the distance of the texels: 1 for two
/// adjacent texels inside an even chart.
struct BorderFace {
    TexelRef a, b;           ///< a before b by slot, then texel
    double conductance = 0;  ///< length over distance
    double distance = 0;     ///< texels
    bool over_seam = false;  ///< the texels are of two charts
};

/// The cell of a texel beside a seam.
struct BorderCell {
    TexelRef texel;   ///< of which it is the cell
    double area = 0;  ///< m²
};

/// One term of the value beyond a texel's chart border: Σ weight w(other) is the value one texel to its `side` (0
/// right, 1 above, 2 left, 3 below), exact for linear w.
struct BorderTap {
    TexelRef texel, other;   ///< beside the border; of which the term is
    std::uint8_t side = 0;   ///< 0–3, as above
    double weight = 0;       ///< may be negative; of one texel and side they sum to 1
    bool over_seam = false;  ///< else `other` is the texel itself or one of the eight round it
};

/// Result of `build_border_cells`.
struct BorderCells {
    std::vector<BorderTap> taps;    ///< by texel, then side
    std::vector<BorderCell> cells;  ///< of all texels with a neighbour over a seam; by slot, then texel
    std::vector<BorderFace> faces;  ///< between any two of them; by a, then b
};

/// Returns the Voronoi cells of the texels beside seams, among the texels of their chart and those over the seams,
/// unrolled about the seam. The texels of both sides tile the surface together: whole inside their charts, cut
/// along the seam. A face is perpendicular to the line between its texels, so flux = k · conductance · (w_a − w_b)
/// is exact for linear w ([Eymard2000], admissible meshes). Texels are whole beyond borders of
/// the surface and at more than one seam at once. The same bits for any number of threads. `only_cells`: without
/// taps and faces, in half of the memory.
BorderCells build_border_cells(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                               bool only_cells = false);

}  // namespace tuft::atlas
