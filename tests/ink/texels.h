#pragma once

#include <array>

#include "atlas/texels/texel_map.h"
#include "core/random.h"

/// Values of a tile's texels to put into kernels.
namespace tuft::ink {

inline constexpr int kN = atlas::kTileTexels;
using Texels = std::array<float, kN>;

inline Texels constant(float v) {
    Texels a;
    a.fill(v);
    return a;
}

inline Texels random_texels(std::uint64_t seed, double lo, double hi) {
    Texels a;
    for (int t = 0; t < kN; ++t) a[t] = static_cast<float>(lo + (hi - lo) * uniform(seed, t));
    return a;
}

}  // namespace tuft::ink
