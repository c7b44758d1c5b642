#pragma once

#include <array>
#include <span>

#include "core/geometry/types.h"

namespace tuft::atlas {

/// A rigid motion of the plane: turned by the angle of cosine c and sine s, then shifted.
struct RigidMotion {
    double c = 1, s = 0;
    Vec2 shift{0};
    Vec2 operator()(const Vec2& p) const { return Vec2(c * p.x - s * p.y, s * p.x + c * p.y) + shift; }
};

/// The motion that brings the second places of the pairs nearest to the first ones, by least
/// squares: argmin Σ |p − m(q)|² (Kabsch 1976, in the plane). The identity for no pairs.
RigidMotion fit_motion(std::span<const std::array<Vec2, 2>> pairs);

}  // namespace tuft::atlas
