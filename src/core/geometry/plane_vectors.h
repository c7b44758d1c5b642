#pragma once

#include <cmath>

#include "core/geometry/types.h"

/// \file
/// Products and rotations of vectors of the plane. `mesh`, `atlas`, `stroke`, `writer` and `io` use them.
namespace tuft {

/// Returns a.x b.y − a.y b.x: the area of the parallelogram of a and b, positive where b lies to the left of a with y
/// up.
inline double cross(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Returns the angle from a to b in (−π, π], radians, from +x towards +y; 0 where either is zero.
inline double angle_between(const Vec2& a, const Vec2& b) {
    return std::atan2(cross(a, b), glm::dot(a, b));
}

/// Returns v rotated by `angle` radians from +x towards +y.
inline Vec2 turned(const Vec2& v, double angle) {
    return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
}

}  // namespace tuft
