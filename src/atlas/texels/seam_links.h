#pragma once

#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// \file
/// Adjacent texels over chart seams, for fluxes along the surface. Used by the wet film and the paste.
namespace tuft::atlas {

/// Texel `texel` of the slot that holds the link and `other_texel` of `other_slot`
/// face each other over a seam: `BorderFace`. `weight` = shared length over distance, both in
/// texels: 1 is the coupling of two texels side by side inside a chart, so
/// flux = k · weight · (w_a − w_b). Each link is held by both of its tiles with the
/// same weight, so the two fluxes cancel to the bit. Scale k where k Σ weight > 1.
struct SeamLink {
    std::uint32_t other_slot = kNone;         ///< of the other chart's tile
    float weight = 0;                         ///< ≥ 0
    std::uint8_t texel = 0, other_texel = 0;  ///< of their slots
    std::uint8_t apart = 64;                  ///< distance, 64ths of a texel
};

/// A face between two texels of one chart beside a seam, as `BorderFace`: of `texel` and the one to the right, above,
/// above right or above left of it.
struct SeamFace {
    enum Direction : std::uint8_t { right, above, above_right, above_left };
    std::uint8_t texel = 0;       ///< of the slot
    Direction direction = right;  ///< to the other texel
    float conductance = 0;        ///< as in `BorderFace`
};

/// `BorderTap`: with all of the same texel and side, what lies one texel to that side.
struct SeamTap {
    std::uint32_t other_slot = kNone;  ///< kNone: `other_texel` is column + 1 + 3 (row + 1) from this texel
    float weight = 0;                  ///< may be negative
    std::uint8_t texel = 0, other_texel = 0, side = 0;  ///< as in `BorderTap`
};

/// Links, faces and taps of all tiles beside seams.
struct SeamLinks {
    std::vector<std::uint32_t> start;       ///< [n_slots + 1]
    std::vector<SeamLink> links;            ///< by slot, then texel, then other end
    std::vector<std::uint32_t> face_start;  ///< [n_slots + 1]
    std::vector<SeamFace> faces;            ///< by slot, then texel: they take the place of the grid's own
    std::vector<std::uint32_t> tap_start;   ///< [n_slots + 1]
    std::vector<SeamTap> taps;              ///< by slot, then texel, then side
};

/// The faces of `build_border_cells`, as tiles hold them. The same bits for any number of threads.
SeamLinks build_seam_links(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map);

}  // namespace tuft::atlas
