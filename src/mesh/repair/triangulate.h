#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Triangulation of one polygon. Used by `build_surface` only.
namespace tuft::mesh {

/// Bound on the work of ear clipping, which is quadratic on a hostile polygon. Each test of a corner against an ear
/// costs one. When the budget is spent, the rest of a polygon becomes a fan.
struct EarBudget {
    std::uint64_t tests = 300'000'000;
    bool ran_out = false;
};

/// Appends n−2 triangles as triples of positions in `corners` (0 ... n−1), with the polygon's winding; none for n <
/// 3. A quad is cut along the diagonal that leaves both halves on its side, the shorter one if both do. Longer
/// polygons are cut by ear clipping [Meisters1975] in the plane of their Newell normal, shortest cut first.
/// Concave and keyhole polygons give correct results. A self-intersecting polygon still gives n−2 triangles.
void triangulate(std::span<const Vec3> corners, EarBudget& budget,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tuft::mesh
