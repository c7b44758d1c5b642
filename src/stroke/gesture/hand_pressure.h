#pragma once

#include <string>
#include <vector>

#include "stroke/journal/trace.h"

/// Pressure for hands whose device has none, from how they move.
namespace tuft::stroke {

enum class PressureFrom { none, speed, dwell, speed_dwell };

/// "none", "speed", "dwell", "speed+dwell", and back; throws `Error` for another word.
std::string name_of(PressureFrom from);
PressureFrom pressure_from(const std::string& name);

/// The hand presses `level` where it goes slowly without resting. With speed v and rest q,
///
///     goal = level (1 − speed_effect (1 − e^{−v/fast})) (1 + dwell_effect q),
///     dq/dt = (1 / (1 + (v/still)²) − q) / dwell_time
///
/// (the first factor for `speed`, the second for `dwell`), clamped to [0, 1]; the pressure
/// follows the goal in `follow`, and reaches it from 0 in about 3 × `follow` after pen down.
/// Speed is that of the samples under a low-pass of `speed_time`.
struct PressureOptions {
    PressureFrom from = PressureFrom::speed_dwell;
    double level = 0.5;         ///< 0–1 of the working depth
    double speed_effect = 0.6;  ///< part of the pressure lost at high speed
    double fast = 0.12;         ///< m/s
    double dwell_effect = 0.6;  ///< part gained by resting
    double still = 0.006;       ///< m/s, below which the hand rests
    double dwell_time = 0.35;   ///< seconds
    double speed_time = 0.03;   ///< seconds
    double follow = 0.025;      ///< seconds
};

struct PressureState {
    bool started = false;
    double time = 0;      ///< seconds
    Vec3 position{0};     ///< metres
    double speed = 0;     ///< m/s, filtered
    double rest = 0;      ///< q
    double pressure = 0;  ///< 0–1
};

/// The pressure of the next sample of a hand at `position` (metres). The first is 0: pen down.
/// Steps of any length give the same curve to the order of (dt / follow).
double press(PressureState& state, const Vec3& position, double time, const PressureOptions& options = {});

/// The pressures of a whole flat trace: as above, but the hand is in motion when it
/// touches (its first speed is that of its first samples), and lifts while it still moves:
/// over the last 3 mm, at most a quarter of the way, the pressure runs out, and in 60 ms more
/// (samples are added) the tip is taken back over ink as it leaves. `none` changes nothing.
Trace press(Trace trace, const PressureOptions& options);

}  // namespace tuft::stroke
