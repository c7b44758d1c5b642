#pragma once

#include <cstdint>
#include <span>

#include "footprint/outline/outline.h"

/// \file
/// Roughness of the edge of wet hair. Ink closes the gaps between hairs, but the edge is where the outermost hairs lie,
/// and on paper where its grain lets ink run. Called by `stroke` for every stamp of still ink.
///
/// Each point of an outline moves along its outward unit normal n by
///
///     δ = w D (A h(x, s) + B c k(x, s)) + w' G r(P),   D = min(d, 0.1 mm) (0.3 + 0.7 ζ / (ζ + 10 µm)),
///
/// with the rms height ζ of the substrate's grain: on a smooth glaze the ink's own surface draws the edge straight.
/// x = t × (p − foot) / d, the number of hairs beside the hand's path, s = travel + t · (p − foot), the place along it,
/// t the unit direction of the hand. While the hand goes straight on, x and s of a place on the surface do not change,
/// so the edge that the stamps leave together is the displaced edge. h and k are value noise with cells of one hair
/// across, 3 and 0.8 mm along for h: at the flanks the edge goes from hair to hair; at the ends, where n lies along t,
/// each hair ends by itself. c is ⟨(n·t)² − 0.05⟩ / 0.95. Ends of coarse bristles are split, so that they move the edge
/// by no more than D. r is the substrate's grain at P in space, of unit rms. Its amplitude is G = 0.35 l ζ / (ζ
/// + 10 µm), with length l and rms height ζ of the grain. The mean of δ is 0.
///
/// w falls from 1 to 0 where a cell, half a texel, grows from a quarter of the spacing to three quarters, w' from half
/// of l to 1.25 of it: detail below a texel vanishes. Where w D is less than 0.2 texels the
/// hair's part is left out: its rms would be 0.04 texels at the flanks, 0.08 at the ends. In marks narrower than
/// sixteen hairs δ is reduced in proportion.
namespace tuft::footprint {

/// Hair at the edge, and its motion.
struct EdgeHair {
    double spacing = 0;      ///< d: metres between hairs that lie side by side; 0: the edge is smooth
    std::uint64_t seed = 0;  ///< of the hair
    double travel = 0;       ///< metres of the hand over the surface so far
    Vec2 foot{0};            ///< of the hand, metres, in the stamp's (u, v)
    Vec2 direction{1, 0};    ///< t
};

/// Grain of the substrate.
struct EdgeGrain {
    double relief = 0;     ///< ζ, metres; 0: none
    double length = 1e-4;  ///< l, metres
};

/// Noise of the edge of still ink.
struct RoughEdge {
    EdgeHair hair;
    EdgeGrain grain;
};

/// Returns the union of the outlines with rough edges as a picture; see `rasterise` (outline.h). For a smooth edge it
/// is that picture, to the bit. Cost: about 15 ns a point: one each texel across the hand's path, and on grain, else
/// one each 0.2 mm along it.
Footprint rasterise(std::span<const Outline> outlines, const PicturePlane& plane, const RoughEdge& edge);

}  // namespace tuft::footprint
