#pragma once

#include <array>
#include <span>

#include "atlas/texels/texel_map.h"
#include "core/geometry/types.h"

/// \file
/// Film that a stamp leaves at each place across its hair, relative to its mean: a bundle that holds more ink leaves
/// more. Called by `stroke` for every tile of a batch of stamps.
namespace tuft::ink {

inline constexpr int kToneSamples = 256;

/// A profile across the hair, in space. Sample i lies where across · (p − origin) = i. Beyond both ends it is even.
struct FilmTone {
    bool even = true;                      ///< 1 everywhere; the rest is not set
    Vec3 origin{0};                        ///< metres, world
    Vec3 across{0};                        ///< samples a metre, world
    std::array<float, kToneSamples> film;  ///< relative, mean 1
};

/// Multiplies `tone` by the profile at the texels of a tile, linear between samples. Cost: about 0.3 µs.
void apply_profile(std::span<float, atlas::kTileTexels> tone, const FilmTone& profile, const atlas::TexelShape& shape);

/// Multiplies `tone` by max(0, 1 + share · r), r the depth of the grain (relief.h): ink stands in its valleys.
void apply_grain(std::span<float, atlas::kTileTexels> tone, std::span<const float, atlas::kTileTexels> relief,
                 float share);

/// Returns the share of `apply_grain` for a film of `film` units on grain of rms height `relief` (metres),
///
///     0.35 ζ / (ζ + film),
///
/// 0 where that is less than 0.03: nobody sees it.
float grain_share(double relief, double film);

}  // namespace tuft::ink
