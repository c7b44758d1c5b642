#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Welding of coincident points. Used by `build_surface` only.
namespace tuft::mesh {

/// Returns, for each point, the lowest index of a point with exactly equal coordinates (−0 equals 0). [n]. Cost:
/// linear time by hashing.
std::vector<std::uint32_t> weld_exact(std::span<const Vec3f> points);

/// Welds each point of `candidates` (ascending) to an earlier candidate within `tolerance` metres. The target must
/// be its own target; the nearest is taken. Changes only those entries of `target`. Cost: linear time by a grid of
/// cells of that size.
void weld_near(std::span<const Vec3f> points, std::span<const std::uint32_t> candidates, double tolerance,
               std::vector<std::uint32_t>& target);

}  // namespace tuft::mesh
