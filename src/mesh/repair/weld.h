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

/// Welds the ends of each edge of a polygon that is at most `shortest` metres long: a pole whose radius came out as
/// sin π, 1e-16, is a ring of such edges. `target` is that of `weld_exact`; of points that are joined the lowest stays.
/// Polygon p has the corners from polygon_start[p] to polygon_start[p + 1]. Cost: linear time.
void weld_short_edges(std::span<const Vec3f> points, std::span<const std::uint32_t> corners,
                      std::span<const std::uint32_t> polygon_start, double shortest,
                      std::vector<std::uint32_t>& target);

/// Welds each point of `candidates` (ascending) to an earlier candidate within `tolerance` metres. The target must
/// be its own target; the nearest is taken. Changes only those entries of `target`. Cost: linear time by a grid of
/// cells of that size.
void weld_near(std::span<const Vec3f> points, std::span<const std::uint32_t> candidates, double tolerance,
               std::vector<std::uint32_t>& target);

}  // namespace tuft::mesh
