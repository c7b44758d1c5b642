#pragma once

#include <array>
#include <span>

#include "core/geometry/types.h"

/// \file
/// Least-squares rigid motion of the plane, for charts that are joined.
namespace tuft::atlas {

/// A rigid motion of the plane: rotation by the angle of cosine c and sine s, then translation.
struct RigidMotion {
    double c = 1, s = 0;  ///< unit
    Vec2 shift{0};        ///< in the unit of the points
    Vec2 operator()(const Vec2& p) const { return Vec2(c * p.x - s * p.y, s * p.x + c * p.y) + shift; }
};

/// Returns the motion m that minimises Σ |p − m(q)|² over the pairs (p, q) ([Kabsch1976], in the plane). The
/// identity for no pairs.
RigidMotion fit_motion(std::span<const std::array<Vec2, 2>> pairs);

}  // namespace tuft::atlas
