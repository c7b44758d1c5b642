#pragma once

#include <algorithm>

#include "core/geometry/types.h"

/// \file
/// Closest point on a line segment, in two or three dimensions. Used by `atlas`, `decal`, `stroke` and `io` for
/// distances from borders, seams and stencil edges.
namespace tuft {

/// Returns the parameter λ in [0, 1] of the point a + λ (b − a) that is closest to p. Returns 0 where a = b.
template <class Vec>
auto nearest_part(const Vec& a, const Vec& b, const Vec& p) {
    using Real = typename Vec::value_type;
    const Vec edge = b - a;
    const Real length2 = glm::dot(edge, edge);
    return length2 > 0 ? std::clamp(glm::dot(p - a, edge) / length2, Real(0), Real(1)) : Real(0);
}

/// Returns true when the ray from p towards +x crosses the segment a–b. Inside a polygon (even-odd) it crosses an odd
/// number of edges.
inline bool crosses_ray(const Vec2& a, const Vec2& b, const Vec2& p) {
    return (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
}

/// Returns the distance from p to the segment a–b.
template <class Vec>
auto segment_distance(const Vec& a, const Vec& b, const Vec& p) {
    return glm::length((p - a) - nearest_part(a, b, p) * (b - a));
}

}  // namespace tuft
