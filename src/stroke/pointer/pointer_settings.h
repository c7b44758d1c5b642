#pragma once

#include "stroke/gesture/hand_filter.h"
#include "stroke/gesture/hand_pressure.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// How a pointer holds a brush, in the terms of a person. pointer_input.h takes filter and pressure from `gesture` with
/// the options that these settings are mapped to.
namespace tuft::stroke {

/// Settings of a pointer device.
struct PointerSettings {
    double pressure = 0.45;              ///< 0–1, fraction of the working depth in slow motion
    double speed_effect = 0.5;           ///< fraction of the pressure lost at 0.25 m/s and above, or at
                                         ///< `kFastPixels` and above where that is faster
    double dwell_effect = 0.25;          ///< pressure added by dwelling
    double smoothing = 0.03;             ///< seconds, time constant of the low-pass on position
    double string = 0;                   ///< metres, length of the string by which the cursor pulls the brush
    double pen_least = 0, pen_full = 1;  ///< pen pressures of depth 0 and of the full depth
    double pen_gamma = 1;                ///< exponent in between
    Vec2 tilt{0};                        ///< radians, lean of the holder to the right and upwards in the view
    double roll = 0;                     ///< radians, of a wide ferrule about the holder's axis, anticlockwise seen
                                         ///< from the handle's end; 0: its broad side is across the view
    bool roll_follow = false;            ///< the broad side turns across the path (roll.h); `roll` is added
    bool clean_ends = true;              ///< for strokes without a pen: see `PointerInput`
};

/// Returns the depth for a pen's pressure p, as a fraction of the working depth: ((p − least) / (full − least)) ^
/// gamma, clamped to 0–1.
double pen_depth(const PointerSettings& settings, double pressure);

/// Returns the law of a pointer's pressure, by speed and dwell, slower than that of a whole trace: a cursor goes in
/// steps of a pixel, and the slow ends of a stroke are no rest. The loss is linear: a hand that draws slowly keeps its
/// line's width. A brush presses 0.02 at least: it stays down.
PressureOptions pressure_options(const PointerSettings& settings);
/// Speed of a cursor that is fast to its hand, pixels a second. Where a whole car is in view a slow hand goes metres a
/// second over it.
inline constexpr double kFastPixels = 600;
/// Returns the same law where a pixel is that many metres on the model.
PressureOptions pressure_options(const PointerSettings& settings, double metres_per_pixel);

/// Returns the filter of a pointer's position: of a fixed time constant, so that a fast hand is a little behind its
/// cursor. On that last part of its path, which is known, it lifts the brush.
OneEuroOptions position_filter(const PointerSettings& settings);

/// Returns a pointer's settings for those of a stroke: string, roll and filter, whose strength 1 is the pointer's
/// default, and which part of the pressure comes from motion.
PointerSettings pointer_settings(const StrokeSettings& settings);

}  // namespace tuft::stroke
