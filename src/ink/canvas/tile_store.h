#pragma once

#include "atlas/texels/texel_map.h"

/// The one place where a kernel's amounts go into a tile.
namespace tuft::ink {

/// w += part · dw over a tile's texels; returns Σ (stored change) · area, so that what is booked
/// is what float texels took, summed in lanes of fixed order. All [n], whole rows; rows left out because
/// nothing changes there do not change the sum's bits.
double store_change(float* __restrict w, const float* __restrict dw, float part, const float* __restrict area,
                    int n = atlas::kTileTexels);

}  // namespace tuft::ink
