#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "ink/canvas/canvas.h"

/// \file
/// Settling of thin ink on the relief of thick paint: it leaves the ridges and fills the furrows. Called by
/// `stroke` at the end of a stroke.
namespace tuft::ink {

/// Options of `pool`.
struct PoolOptions {
    double ridge_film = 0.4;  ///< film units held by the ridges
    double pin = 1.5;         ///< film units needed to wet dry texels
    double reach = 0.6e-3;    ///< metres over which ink settles
    double strength = 1;      ///< of the ink: pigments in a film unit
    /// Empty: all; no ink crosses to or from texels that are not free.
    std::function<bool(std::uint32_t slot, int texel)> free = {};
};

/// Returns the height of dry paint above the substrate, micrometres: `TileAppearance::height` without the open
/// film. Heights below kPlain are no relief: glazes do not settle on glazes.
inline constexpr double kPlain = 30;  // micrometres
Plane dry_relief(const Canvas& canvas, std::uint32_t slot);

/// Settles the ink that a stroke added to the open films since `before` on the relief of the paint below. Surface
/// tension and gravity level a film thinner than the capillary length (2.7 mm) within milliseconds where the slope
/// drives it ([Orchard1962]: time constant 3 η λ⁴ / (σ h³ (2π)⁴), 5 ms for λ = 0.5 mm, h = 20 µm, η = 10 mPa s); a
/// film held by the wall does not move. With z the relief and T the film, in each step
///
///     F = n min(⟨T − ridge_film⟩, ⟨z + T − z' − T'⟩) / 5   from texel to lower texel,
///
/// n is 1 on relief and falls to 0 over `reach` beside it; ⟨T − pin⟩ onto texels without ink. The surface in a
/// furrow becomes level and thins to 0 at its walls. Pigments move in proportion. The flux through a face is one
/// number for both sides, over seams too: each pigment is conserved to rounding. The same bits for any number of
/// threads. Only tiles changed by the stroke take part. Cost: about 0.1 ms a tile.
void pool(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
          std::span<const TileSnapshot* const> before, const PoolOptions& options);

}  // namespace tuft::ink
