#pragma once

#include <span>

#include "ink/exchange/reservoir.h"

namespace tuft::ink {

/// Mixes what neighbouring bundles hold as the tuft bends. Hair does not stretch: where its
/// direction turns by `turned` (radians along the section's x and y), bundles that lie d apart slide
/// along each other by |d · turned|, and the liquid between them is sheared. Of the smaller content
/// the part ½ (1 − exp(−slip / 3 mm)) changes places with as much of the other. A tuft drawn evenly
/// keeps its inks apart; one that is stirred to and fro mixes them. Each plane's sum is kept to
/// rounding. `turned`: [cells of a bundle]; `radius` of the tuft, metres.
void stir(Reservoir& tuft, std::span<const Vec2> turned, double radius);

}  // namespace tuft::ink
