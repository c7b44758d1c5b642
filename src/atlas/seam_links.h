#pragma once

#include <cstdint>
#include <vector>

#include "atlas/texel_map.h"

/// Neighbour texels over chart seams, for whatever flows along the surface.
namespace tuft::atlas {

/// Texel `texel` of the slot that holds the link and `other_texel` of `other_slot`
/// face each other over a seam. `weight` = shared length over distance, both in
/// texels: 1 is the coupling of two texels side by side inside a chart, so
/// flux = k · weight · (w_a − w_b). Each link is held by both of its tiles with the
/// same weight, so the two fluxes cancel to the bit. Scale k where k Σ weight > 1.
struct SeamLink {
    std::uint32_t other_slot = kNone;
    float weight = 0;
    std::uint8_t texel = 0, other_texel = 0;
};

/// What the texels beside a seam lack of conductance along it, or, below zero, have too much of: links run askew, by
/// t texels along the seam, and let as much flow along it as ½ weight t² of a texel; and where the edge of the
/// texels goes up in steps they have no faces on that side. A tensor as √g times the inverse metric is.
struct SeamBalance {
    std::uint8_t texel = 0;
    float m11 = 0, m12 = 0, m22 = 0;
};

struct SeamLinks {
    std::vector<std::uint32_t> start;  ///< [n_slots + 1]
    std::vector<SeamLink> links;       ///< by slot, then texel, then other end
    std::vector<std::uint32_t> balance_start;  ///< [n_slots + 1]
    std::vector<SeamBalance> balance;  ///< by slot, then texel
};

/// Walks every seam in quarter texels and couples the nearest texels of both sides.
/// The same bits for any number of threads.
SeamLinks build_seam_links(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map);

}  // namespace tuft::atlas
