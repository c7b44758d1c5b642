#pragma once

#include <deque>

#include "brush/state/tuft_state.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// Filters of a hand's samples as they arrive: a low-pass that follows fast motion (smoothing), and a string that pulls
/// the tip (stabiliser). Called by hand.h. States are plain structs; the same samples give the same bits.
namespace tuft::stroke {

/// One-Euro filter [Casiez2012]: exponential smoothing whose cutoff
/// frequency rises with the speed of the signal,
///
///     x̂' = (x − x̂) / τ,  τ = 1 / (2π f),  f = cutoff + beta |v̂|
///
/// solved exactly for a signal that is linear between samples, so that the result does not depend on their rate. v̂ is
/// the difference quotient of the raw signal, filtered with the fixed cutoff `rate_cutoff`; it starts with the first
/// difference. A vector has one cutoff, from |v̂|, so that a straight path stays straight. At constant speed v the
/// output lags by v / (2π (cutoff + beta v)) < 1 / (2π beta).
struct OneEuroOptions {
    double cutoff = 1.2;     ///< Hz, at rest
    double beta = 0;         ///< Hz per unit of speed
    double rate_cutoff = 3;  ///< Hz
};

/// State of the filter. V: double, Vec2 or Vec3.
template <class V>
struct OneEuro {
    bool started = false, moved = false;  ///< one sample, two samples have come
    double time = 0;                      ///< seconds, of the last sample
    V raw{}, value{}, rate{};             ///< x, x̂, v̂
};

/// Returns the filtered value of the next sample. A time that does not rise counts as 1 ms later.
template <class V>
V filter(OneEuro<V>& state, const V& sample, double time, const OneEuroOptions& options);

/// The same for rotations: filtered along the shortest arc, speed in rad/s.
struct OneEuroTurn {
    bool started = false, moved = false;
    double time = 0;
    Quat raw{1, 0, 0, 0}, value{1, 0, 0, 0};
    double rate = 0;  ///< rad/s
};
Quat filter(OneEuroTurn& state, const Quat& sample, double time, const OneEuroOptions& options);

/// Defaults for a hand. White jitter of 0.15 mm per axis (1–2 pixels of a model that fills the screen) loses over 90 %
/// of its power at rest, 75 % at 20 mm/s. The lag of a steady motion is at most 0.53 mm, of a steady change of pressure
/// 0.02, of tilt 0.02 rad.
struct HandFilterOptions {
    OneEuroOptions position{.cutoff = 1.2, .beta = 300};  ///< Hz, Hz per m/s
    OneEuroOptions pressure{.cutoff = 2, .beta = 8};      ///< Hz, Hz per 1/s
    OneEuroOptions tilt{.cutoff = 1.5, .beta = 8};        ///< Hz, Hz per rad/s; rotation too
};

/// Returns the defaults with every lag multiplied by `strength` > 0.
HandFilterOptions hand_filter_options(double strength);

/// States of the filters of one hand.
struct HandFilter {
    OneEuro<Vec3> position;
    OneEuro<double> pressure;
    OneEuro<Vec2> tilt;
    OneEuro<double> roll;
    OneEuroTurn rotation;
};

/// Returns the next sample with position, pressure, tilt, roll and rotation filtered. Its time stays, and a pressure of
/// 0 stays 0: pen up.
StrokeSample smooth(HandFilter& state, const StrokeSample& sample, const HandFilterOptions& options = {});
brush::Pose smooth(HandFilter& state, const brush::Pose& pose, const HandFilterOptions& options = {});

/// A tip pulled on a string. It rests while the string is slack and follows the hand while it is taut (`drag_string`,
/// exact for a hand that moves straight between samples). |hand − tip| ≤ length, and a tremor of the hand within the
/// string's length does not move the tip.
struct String {
    bool started = false;
    Vec3 tip{0}, hand{0};  ///< metres
    double travel = 0;     ///< metres of the hand's path
    struct Grip {
        double travel = 0;  ///< metres of the hand's path
        double pressure = 0;
        Vec2 tilt{0};
        double roll = 0;
    };
    std::deque<Grip> past;  ///< pressures and tilts between tip and hand
};

/// Moves the tip; `length` in metres. Returns the tip's position with the pressure, tilt and roll that the hand had
/// |hand − tip| of its path before, so that they stay at their place. A string of length 0 changes nothing.
StrokeSample pull(String& state, const StrokeSample& hand, double length);

/// Ends the string: the tip goes straight to the hand's last position at `speed` (m/s), through the pressures between
/// them. Appends samples at most `spacing` metres apart to `out`, with times after `time`.
void let_go(String& state, double time, double speed, double spacing, std::vector<StrokeSample>& out);

/// The same for a ferrule in space. The string acts across the holder's axis; motion along the axis and rotation pass
/// through without delay.
brush::Pose pull(String& state, const brush::Pose& hand, double length);

}  // namespace tuft::stroke
