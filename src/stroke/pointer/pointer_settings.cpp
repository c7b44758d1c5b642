#include "stroke/pointer/pointer_settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::stroke {

double pen_depth(const PointerSettings& s, double pressure) {
    return std::pow(std::clamp((pressure - s.pen_least) / std::max(1e-3, s.pen_full - s.pen_least), 0.0, 1.0),
                    s.pen_gamma);
}

PressureOptions pressure_options(const PointerSettings& s) {
    constexpr double kLeast = 0.02;
    return {.level = s.pressure,
            .speed_effect = s.speed_effect,
            .fast = 0.25,
            .dwell_effect = s.dwell_effect / std::max(kLeast, s.pressure),
            .still = 0.003,
            .dwell_time = 0.5,
            .speed_time = 0.05,
            .follow = 0.05,
            .least = kLeast,
            .linear = true};
}

PressureOptions pressure_options(const PointerSettings& s, double metres_per_pixel) {
    PressureOptions options = pressure_options(s);
    const double slower = std::max(1.0, kFastPixels * metres_per_pixel / options.fast);
    options.fast *= slower;
    options.still *= slower;
    return options;
}

OneEuroOptions position_filter(const PointerSettings& s) {
    constexpr double kShortest = 1e-6;  // seconds
    return {.cutoff = 1 / (2 * std::numbers::pi * std::max(kShortest, s.smoothing))};
}

PointerSettings pointer_settings(const StrokeSettings& stroke) {
    PointerSettings s;
    if (stroke.pressure == PressureFrom::dwell) s.speed_effect = 0;
    if (stroke.pressure == PressureFrom::speed) s.dwell_effect = 0;
    s.smoothing *= stroke.smooth;
    s.string = stroke.stabilise;
    s.roll = stroke.roll;
    s.roll_follow = stroke.roll_follow;
    return s;
}

}  // namespace tuft::stroke
