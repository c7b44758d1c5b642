#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/types.h"

/// From UVs in double to floats without losing a triangle.
namespace tuft::atlas {

/// Rounds UVs in [0, 1] to the grid on which floats lie (2⁻²⁴) and moves vertices by as
/// few steps as it takes until every triangle of `faces` has a positive area there,
/// exactly. Returns the triangles for which no place within 1/16 texel was found.
std::vector<std::uint32_t> snap_to_floats(const std::vector<std::array<std::uint32_t, 3>>& faces, std::vector<Vec2>& uv,
                                          std::uint32_t size);

}  // namespace tuft::atlas
