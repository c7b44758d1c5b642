#pragma once

#include <cmath>

#include "core/geometry/types.h"

/// \file
/// What is too large or too small to be a thing somebody paints on. Every entrance checks its
/// numbers against these: model files, stroke files, projects, command line, scripts. Inside,
/// squares and fourth powers of lengths then stay far within the range of single precision.
namespace tuft {

/// Metres from the origin: no point of a model, of a placement or of a hand lies further away.
/// Single precision resolves a millimetre there.
inline constexpr double kFarthest = 1e4;

/// Metres across: no model is smaller.
inline constexpr double kSmallestModel = 1e-6;

/// The same bound for points of a file whose unit is not known yet, as numbers: `kFarthest` in the
/// smallest unit, micrometres.
inline constexpr double kFarthestNumber = kFarthest * 1e6;

/// Whether all coordinates are numbers within ±`most`; NaN and infinity are not.
inline bool within(const Vec3& p, double most = kFarthest) {
    return std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most;
}
inline bool within(const Vec2& p, double most = kFarthest) {
    return std::abs(p.x) <= most && std::abs(p.y) <= most;
}

}  // namespace tuft
