#pragma once

#include <algorithm>

namespace tuft {

/// 3x² − 2x³ between 0 and 1, flat beyond.
template <class Real>
Real smooth_step(Real x) {
    x = std::clamp(x, Real(0), Real(1));
    return x * x * (3 - 2 * x);
}

}  // namespace tuft
