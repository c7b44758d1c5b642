#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/atlas.h"

/// What a set of UVs covers: texels, and the module between charts.
namespace tuft::atlas {

/// Half-edges across which the UVs do not agree at both ends, and borders. [3n]
std::vector<std::uint8_t> uv_seams(std::span<const std::uint32_t> twin, std::span<const Vec2f> corner_uvs);

struct Coverage {
    std::size_t covered = 0;                  ///< texel centres inside a triangle
    std::size_t twice = 0;                    ///< inside more than one
    std::vector<std::uint32_t> charts_twice;  ///< charts with such texels, ascending; see `cover`
};

/// Rasters all triangles into a page of size × size texels: 2 bits per texel.
/// `charts_twice` is filled when `triangle_chart` is given.
Coverage cover(std::span<const Vec2f> corner_uvs, std::span<const std::uint32_t> triangle_chart, std::uint32_t size);

/// Texels between the two nearest charts, rounded down, 64 at most; from the exact
/// distance of their borders, the half-edges marked in `seam`. UVs that are not finite are
/// and edges outside the page are left out.
int smallest_gap(std::span<const std::uint8_t> seam, std::span<const Vec2f> corner_uvs,
                 std::span<const std::uint32_t> triangle_chart, std::uint32_t size);

/// The same for charts on the same page of an atlas.
int smallest_gap(std::span<const std::uint8_t> seam, const Atlas& atlas);

}  // namespace tuft::atlas
