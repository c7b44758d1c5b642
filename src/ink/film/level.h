#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>

#include "atlas/texels/seam_links.h"
#include "ink/canvas/canvas.h"

namespace tuft::ink {

/// Tiles with the pigment in their open films (`open_pigment`) as it was before.
using OpenBefore = std::unordered_map<std::uint32_t, std::unique_ptr<Plane>>;

/// Rounds fresh paste over `length` metres (`levelling_length`), seams or not: each pigment of the
/// open film diffuses between texels on which the film has changed since `before` and is not bare,
/// so that waves of wavenumber k keep exp(−(k length)² / 2) of their height and edges stay where
/// they are. Explicit steps with antisymmetric fluxes: each pigment is kept to rounding. The same
/// bits for any number of threads. About 1 µs per tile, step and pigment; `length` over a texel,
/// squared and times 2.5, are steps, 64 at most.
void level_paste(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const OpenBefore& before,
                 double length);

}  // namespace tuft::ink
