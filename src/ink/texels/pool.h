#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "ink/canvas/canvas.h"

/// Thin ink over thick paint: it runs off the ridges and stands in the furrows.
namespace tuft::ink {

struct PoolOptions {
    double hold = 0.4;      ///< film units that stay on the ridges, held by the wall
    double pin = 1.5;       ///< film units from which dry texels are wetted
    double reach = 0.6e-3;  ///< metres over which it settles
    double strength = 1;    ///< of the ink: pigments in a film unit
    std::function<bool(std::uint32_t slot, int texel)> free = {};  ///< empty: all; nothing goes onto or off what is not
};

/// Micrometres of dry paint above the substrate, as `TileAppearance::height` without what is open.
/// Less than kPlain does not count as relief: glazes lie over glazes as they were put.
inline constexpr double kPlain = 30;  // micrometres
Plane dry_relief(const Canvas& canvas, std::uint32_t slot);

/// Lets what a stroke laid into the open films since `before` settle on the relief of what is dry and of what lay
/// there. Surface tension and weight level a film thinner than the capillary length (2.7 mm) within milliseconds where
/// the ground's slope asks for it (Orchard 1962: time constant 3 η λ⁴ / (σ h³ (2π)⁴), 5 ms for λ = 0.5 mm, h = 20 µm,
/// η = 10 mPa s), and are held by a film that the wall keeps. With z the relief and T the film, in each step
///
///     F = n min(⟨T − hold⟩, ⟨z + T − z' − T'⟩) / 5   from texel to lower texel,
///
/// n 1 where there is relief, falling to 0 over `reach` beside it; ⟨T − pin⟩ onto texels without any. So the surface of
/// what stands in a furrow is level and thins to nothing at its walls. Pigments go with it in their shares. Fluxes
/// through a face, over seams too, are one number for both sides: each pigment is kept to rounding. The same bits for
/// any number of threads. Only tiles that the stroke changed take part. About 0.1 ms a tile.
void pool(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
          std::span<const TileSnapshot* const> before, const PoolOptions& options);

}  // namespace tuft::ink
