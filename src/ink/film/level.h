#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>

#include "atlas/texels/seam_links.h"
#include "ink/canvas/canvas.h"

/// \file
/// Levelling of fresh paste. Called by `stroke` at the end of a stroke.
namespace tuft::ink {

/// Pigment in the open films of tiles (`open_pigment`) before the stroke.
using OpenBefore = std::unordered_map<std::uint32_t, std::unique_ptr<Plane>>;

/// Smooths fresh paste over `length` metres (`levelling_length`), over seams too. Each pigment of the open film
/// diffuses between texels where the film is not bare and has changed since `before`: waves of wavenumber k are
/// reduced to exp(−(k length)² / 2) of their height, and edges do not move. Explicit steps with antisymmetric
/// fluxes: each pigment is conserved to rounding. The same bits for any number of threads. Cost: about 1 µs per
/// tile, step and pigment; 2.5 (length / texel)² steps, at most 64.
void level_paste(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const OpenBefore& before,
                 double length);

}  // namespace tuft::ink
