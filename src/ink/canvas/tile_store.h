#pragma once

#include "atlas/texels/texel_map.h"

/// \file
/// Addition of a kernel's change to a tile, with the ink balance. Called by deposit.h and erase.h.
namespace tuft::ink {

/// Adds w += part · dw over a tile's texels. Returns Σ (stored change) · area: the balance counts what the float
/// texels took. The sum has a fixed order of lanes. All arrays [n], whole rows. Rows without changes may be left
/// out without changing the sum's bits.
double store_change(float* __restrict w, const float* __restrict dw, float part, const float* __restrict area,
                    int n = atlas::kTileTexels);

/// sum += w, and sum += factor · w, over the texels of a tile.
void add_plane(float* __restrict sum, const float* __restrict w);
void add_scaled_plane(float* __restrict sum, const float* __restrict w, float factor);

}  // namespace tuft::ink
