#pragma once

#include <algorithm>

/// \file
/// Smooth step polynomials. `stroke` uses them for fades along a stroke, `core/noise.h` for interpolation.
namespace tuft {

/// 3x² − 2x³ of x in [0, 1], a number or each component of a vector.
template <class T>
T fade(const T& x) {
    return x * x * (T(3) - T(2) * x);
}

/// 3x² − 2x³ between 0 and 1, flat beyond.
template <class Real>
Real smooth_step(Real x) {
    return fade(std::clamp(x, Real(0), Real(1)));
}

}  // namespace tuft
