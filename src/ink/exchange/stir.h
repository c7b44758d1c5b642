#pragma once

#include <span>

#include "ink/exchange/reservoir.h"

/// \file
/// Mixing of inks inside a bending tuft. Called by `stroke` for every sample.
namespace tuft::ink {

/// Mixes neighbouring bundles as the tuft bends. Hair does not stretch: where its direction turns by `turned`
/// (radians along the section's x and y), bundles at distance d slide along each other by |d · turned| and shear
/// the liquid between them. The fraction ½ (1 − exp(−slip / 3 mm)) of the smaller content is exchanged for an equal
/// amount. A steady drag retains separate inks; bending to and fro mixes them. The sum of each plane is conserved
/// to rounding. `turned`: [cells of a bundle]; `radius` of the tuft, metres.
void stir(Reservoir& tuft, std::span<const Vec2> turned, double radius);

}  // namespace tuft::ink
