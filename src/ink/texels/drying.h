#pragma once

#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"

/// \file
/// Drying: the open film becomes a dry film. Called by the wet film and by layer merging.
namespace tuft::ink {

/// Closes the open film of the texels with `closing` [256] ≠ 0: its pigments move unchanged onto the texel's next
/// dry film, above all others. The appearance does not change, since the order of films does not. A film joins the
/// one below if both have the same composition; this does not change the appearance either. When all dry films are
/// used, the two lowest are merged into one mixture, whose colour may change as far as it shows through the others.
/// On a texel without dry films the fraction `stain` goes into the soaked film, and the rest becomes the first dry
/// film. Liquid is ignored. Different threads may process different slots.
void close_films(Canvas& canvas, std::uint32_t slot, std::span<const std::uint8_t, atlas::kTileTexels> closing,
                 float stain = 0);

/// The same for the fraction `part` [256], 0–1, of each texel's open film: in its composition it becomes the next
/// dry film below the rest. Nothing goes into the soaked film.
void close_parts(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> part);

/// Dries the canvas at once: liquid disappears without moving anything, and every open film is closed. Returns the
/// removed liquid, film·m².
double dry_all(Canvas& canvas, const atlas::TexelMap& map);

}  // namespace tuft::ink
