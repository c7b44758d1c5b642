#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/atlas.h"

/// \file
/// Coverage of a page by UVs: covered texels, overlaps, and the gap between charts. Called by `unwrap` and
/// `measure`.
namespace tuft::atlas {

/// Marks half-edges across which the UVs differ at an end, and borders. [3n]
std::vector<std::uint8_t> uv_seams(std::span<const std::uint32_t> twin, std::span<const Vec2f> corner_uvs);

/// Covered texels of a page.
struct Coverage {
    std::size_t covered = 0;                  ///< texel centres inside a triangle
    std::size_t twice = 0;                    ///< inside more than one
    std::vector<std::uint32_t> charts_twice;  ///< charts with such texels, ascending; see `cover`
};

/// Rasters all triangles into a page of size × size texels: 2 bits per texel.
/// `charts_twice` is filled when `triangle_chart` is given.
Coverage cover(std::span<const Vec2f> corner_uvs, std::span<const std::uint32_t> triangle_chart, std::uint32_t size);

/// Returns the texels between the two nearest charts, rounded down, at most 64, from the exact distance of their
/// borders, the half-edges marked in `seam`. UVs that are not finite and edges outside the page are ignored.
int smallest_gap(std::span<const std::uint8_t> seam, std::span<const Vec2f> corner_uvs,
                 std::span<const std::uint32_t> triangle_chart, std::uint32_t size);

/// The same for charts on the same page of an atlas.
int smallest_gap(std::span<const std::uint8_t> seam, const Atlas& atlas);

}  // namespace tuft::atlas
