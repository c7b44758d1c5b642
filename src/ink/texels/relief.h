#pragma once

#include <span>

#include "atlas/texels/texel_map.h"

/// \file
/// Grain of the substrate: a dry brush reaches its peaks and not its valleys. Called by `stroke` for every tile of
/// every stamp.
namespace tuft::ink {

/// Returns the depth of the grain below its mean at a point (metres, model frame), relative to its rms: smooth
/// noise of two octaves with features `length` metres across. A function of the position alone: independent of
/// seams and of resolution.
double relief_at(const Vec3& point, double length);

/// The same at every texel of a tile.
void relief_of_tile(const atlas::TexelShape& tile, double length, std::span<float, atlas::kTileTexels> out);

/// Reduces each texel's exposure to the fraction that hair with a film of `film` metres reaches: clamp(½ + 2 (film
/// − ζ r) / ζ), with ζ the rms height of the grain (metres) and r from `relief_of_tile`.
void expose_relief(std::span<float, atlas::kTileTexels> exposure, std::span<const float, atlas::kTileTexels> relief,
                   float rms, float film);

}  // namespace tuft::ink
