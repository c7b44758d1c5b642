#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Conversion of UVs from double to float without degenerate triangles. Called by `unwrap`.
namespace tuft::atlas {

/// Rounds UVs in [0, 1] to the grid of floats (2⁻²⁴) and moves vertices by as few steps as needed until every
/// triangle of `faces` has an exactly positive area, and, where possible, at least 0.45 of its area before. Returns the
/// triangles for which no position within 1/16 texel gives a positive area.
std::vector<std::uint32_t> snap_to_floats(const std::vector<std::array<std::uint32_t, 3>>& faces, std::vector<Vec2>& uv,
                                          std::uint32_t size);

}  // namespace tuft::atlas
