#pragma once

#include <algorithm>
#include <cmath>

/// \file
/// The hat function of finite elements, as a weight of what is near. Called where means along a path are taken.
namespace tuft {

/// Returns max(0, 1 − |x| / half_width).
inline double hat(double x, double half_width) {
    return std::max(0.0, 1 - std::abs(x) / half_width);
}

}  // namespace tuft
