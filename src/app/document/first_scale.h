#pragma once

#include <algorithm>

#include "app/document/writing.h"

namespace tuft::app {

/// Returns the scale that a drawing comes at over a model of these bounds: its own size, or a third of the model's
/// diagonal where it is wider or higher than each side of the bounds, or smaller than a fiftieth of the diagonal.
inline double first_scale(const Writing& writing, const Box& bounds) {
    const double own = std::max(writing.form().width, writing.form().height), diagonal = bounds.diagonal();
    const Vec3 size = bounds.size();
    const bool fits = own <= std::max({size.x, size.y, size.z}) && own >= 0.02 * diagonal;
    return own > 0 && !fits ? diagonal / 3 / own : 1;
}

}  // namespace tuft::app
