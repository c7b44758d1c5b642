#pragma once

#include <string>
#include <vector>

#include "stroke/journal/entry/samples.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// Pressure from motion, for devices that measure none: a mouse, a finger, a drawing. Called by hand.h for whole traces
/// and, step by step, by the pointer (pointer/pointer_input.h).
namespace tuft::stroke {

/// Pressure p of a hand with speed v and rest q:
///
///     goal = level (1 − speed_effect (1 − e^{−v/fast})) (1 + dwell_effect q),
///     dq/dt = (1 / (1 + (v/still)²) − q) / dwell_time,
///     dp/dt = (goal − p) / follow,
///
/// with the first factor of the goal for `speed`, the second for `dwell`, and the goal clamped to [least, 1]. From pen
/// down p rises to the goal in about 3 × `follow`. v is the speed of the samples after a low-pass of time `speed_time`.
struct PressureOptions {
    PressureFrom from = PressureFrom::speed_dwell;
    double level = 0.5;         ///< pressure of slow motion, part of the working depth, 0–1
    double speed_effect = 0.6;  ///< part of the pressure lost at high speed, 0–1
    double fast = 0.12;         ///< m/s
    double dwell_effect = 0.6;  ///< part of the pressure gained by resting, ≥ 0
    double still = 0.006;       ///< m/s, below which the hand rests
    double dwell_time = 0.35;   ///< seconds
    double speed_time = 0.03;   ///< seconds
    double follow = 0.025;      ///< seconds
    double least = 0;           ///< goal of a hand however fast, 0–1
    bool linear = false;        ///< the loss is speed_effect min(1, v/fast) instead
};

/// Motion of the hand up to the last sample.
struct PressureState {
    bool started = false;
    double time = 0;      ///< seconds
    Vec3 position{0};     ///< metres
    double speed = 0;     ///< m/s, filtered
    double rest = 0;      ///< q
    double pressure = 0;  ///< 0–1
};

/// Takes the next step of a hand that moved `travel` metres in `dt` > 0 seconds: updates v and q.
void track_motion(PressureState& state, double travel, double dt, const PressureOptions& options);
/// Returns the goal of the pressure at the state's v and q.
double pressure_goal(const PressureState& state, const PressureOptions& options);

/// Returns the pressure of the next sample at `position` (metres) and `time` (seconds); 0 for the first one.
/// Independent of the sampling rate to O(dt / follow).
double press(PressureState& state, const Vec3& position, double time, const PressureOptions& options = {});

/// Sets the pressures of a whole flat trace. As above, but the hand moves when it touches and when it lifts. Its
/// initial speed is that of the first samples. Over the last 3 mm, at most a quarter of the path, the pressure falls to
/// 0. In 60 ms more, for which samples are added, the tip is taken back over the ink as it leaves. `PressureFrom::none`
/// changes nothing.
StrokeSamples press(StrokeSamples trace, const PressureOptions& options);

}  // namespace tuft::stroke
