#pragma once

#include "decal/polygons.h"

/// \file
/// Borders of what texels hold without their stairs. Called by ink_areas.h.
namespace tuft::decal {

/// Returns a ring near `ring` that bends less. Points of `ring` a texel apart, or a 16th of a shorter ring, move by
/// steps −λ ∂⁴x/∂s⁴, λ = 0.1 in units of their distance, each within half a texel of where it began: stairs of up to
/// ten texels go, waves over twenty stay. Between them the ring is a Catmull–Rom curve in four steps. Then it is moved
/// out evenly by what its area lacks, to first order.
Ring smooth_ring(const Ring& ring, double texel);

}  // namespace tuft::decal
