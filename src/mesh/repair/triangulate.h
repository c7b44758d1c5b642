#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// Cutting one polygon into triangles. Internal to `mesh`.
namespace tuft::mesh {

/// Keeps ear clipping from taking quadratic time on a hostile polygon: every corner tested
/// against an ear costs one; when it is used up, what is left of a polygon becomes a fan.
struct EarBudget {
    std::uint64_t tests = 300'000'000;
    bool ran_out = false;
};

/// Triangles as triples of positions in `corners` (0 ... n-1), n-2 of them, with the polygon's
/// winding; none for n < 3. A quad is cut along the diagonal that keeps both halves on its
/// side, the shorter one if both do. Longer polygons are cut by ear clipping (Meisters 1975) in
/// the plane of their Newell normal, shortest cut first; concave and keyhole polygons come out
/// right, a polygon that crosses itself still gives n-2 triangles.
void triangulate(std::span<const Vec3> corners, EarBudget& budget,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tuft::mesh
