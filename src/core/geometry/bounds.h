#pragma once

#include <cmath>

#include "core/geometry/types.h"

/// \file
/// Largest and smallest lengths that the program accepts. Every reader of user data checks its numbers against
/// them: model files, stroke files, projects, command line, scripts. Squares and fourth powers of such lengths stay
/// within the range of single precision.
namespace tuft {

/// Largest distance from the origin, metres, of a point of a model, a placement or a hand. Single precision
/// resolves a millimetre there.
inline constexpr double kFarthest = 1e4;

/// Smallest extent of a model, metres.
inline constexpr double kSmallestModel = 1e-6;

/// `kFarthest` as a bare number, for a file whose unit is not known yet. It is counted in the smallest unit,
/// micrometres.
inline constexpr double kFarthestNumber = kFarthest * 1e6;

/// Returns true when every coordinate is a number in [−`most`, `most`]. NaN and infinity give false.
inline bool within(const Vec3& p, double most = kFarthest) {
    return std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most;
}
inline bool within(const Vec2& p, double most = kFarthest) {
    return std::abs(p.x) <= most && std::abs(p.y) <= most;
}

}  // namespace tuft
