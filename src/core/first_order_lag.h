#pragma once

#include <algorithm>
#include <cmath>

/// \file
/// Step of a first-order low-pass. The filters of the hand and of the pointer, and the law of the force use it.
namespace tuft {

/// Returns the part of the distance to a constant goal that a first-order lag of time constant τ goes in `dt`:
/// 1 − e^(−dt/τ). A τ below 1 µs counts as that. Seconds.
inline double settled_part(double dt, double time_constant) {
    return -std::expm1(-dt / std::max(time_constant, 1e-6));
}

}  // namespace tuft
