#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// Finding points that are the same place. Internal to `mesh`.
namespace tuft::mesh {

/// [n] for each point the lowest index of a point with exactly its coordinates (-0 equals 0).
/// Linear time by hashing.
std::vector<std::uint32_t> weld_exact(std::span<const Vec3f> points);

/// Among the points named in `candidates` (ascending), each goes to the first earlier candidate
/// that stands for itself and lies within `tolerance` metres, the nearest if there are several.
/// Changes only those entries of `target`. Linear time by a grid of cells of that size.
void weld_near(std::span<const Vec3f> points, std::span<const std::uint32_t> candidates, double tolerance,
               std::vector<std::uint32_t>& target);

}  // namespace tuft::mesh
