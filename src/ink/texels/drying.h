#pragma once

#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"

/// From the open film to dry ones.
namespace tuft::ink {

/// Closes the open film of the texels with `closing` [256] ≠ 0: its pigment amounts move as
/// they are onto the texel's own next dry film, above all its others. What is seen of the
/// texel stays the same, since the same films lie in the same order. A film of the same
/// composition as the one under it joins it, which changes nothing either (a mixture layered
/// on itself is itself, thicker). A texel whose dry films are used up makes room by merging
/// its two lowest into one mixture, whose colour may change by what still shows of it through
/// all the others. On a texel without dry films, the part `stain` goes into the soaked film
/// instead, below and beside the rest of it. Liquid is not regarded. Slots may be closed by
/// different threads.
void close_films(Canvas& canvas, std::uint32_t slot, std::span<const std::uint8_t, atlas::kTileTexels> closing,
                 float stain = 0);

/// The same for a part of what lies there: of each texel's open film `part` [256], 0–1, in its
/// composition, becomes the next dry film below the rest of it. Nothing goes into the soaked film.
void close_parts(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> part);

/// Lets everything dry at once: liquid goes without moving anything, every open film is
/// closed. Returns the liquid that went, film·m².
double dry_all(Canvas& canvas, const atlas::TexelMap& map);

}  // namespace tuft::ink
