#pragma once

#include <span>

#include "atlas/texels/texel_map.h"

/// The grain of what is painted on: hills that a dry brush reaches and valleys it does not.
namespace tuft::ink {

/// Depth of the surface's grain below its mean at a point (metres, model frame), over its rms:
/// smooth noise of two octaves whose lumps are `length` metres across. A function of the
/// place alone: no seam of the atlas shows in it, and it is the same at any resolution.
double relief_at(const Vec3& point, double length);

/// The same at every texel of a tile.
void relief_of_tile(const atlas::TexelShape& tile, double length, std::span<float, atlas::kTileTexels> out);

/// Leaves of each texel's exposure the part that hair with a film of `film` metres reaches:
/// clamp(½ + 2 (film − ζ r) / ζ), ζ the grain's rms height (metres) and r from `relief_of_tile`.
void expose_relief(std::span<float, atlas::kTileTexels> exposure, std::span<const float, atlas::kTileTexels> relief,
                   float rms, float film);

}  // namespace tuft::ink
