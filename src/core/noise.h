#pragma once

#include <cmath>
#include <cstdint>

#include "core/ease.h"

/// \file
/// Value noise: values at whole numbers, interpolated by 3f² − 2f³ ([Perlin1985] with values in place of gradients).
/// Used by the hair, the furrows, the substrate's grain and the wet film.
namespace tuft {

/// Returns the noise at x ≥ 0, smooth over one unit. `value(cell)` returns the value at a whole number ≥ 0.
template <class Value>
double value_noise(double x, Value&& value) {
    const double floor = std::floor(x), g = fade(x - floor);
    const auto cell = static_cast<std::uint64_t>(floor);
    const double a = value(cell), b = value(cell + 1);
    return a + g * (b - a);
}

}  // namespace tuft
