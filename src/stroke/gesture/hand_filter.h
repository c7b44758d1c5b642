#pragma once

#include <deque>

#include "brush/tuft/tuft_state.h"
#include "stroke/journal/samples.h"

/// Steadies a hand as its samples arrive: a low-pass that follows fast motion, and a string
/// that pulls the tip. A state is a plain struct; the same samples give the same bits.
namespace tuft::stroke {

/// One-Euro filter (Casiez, Roussel and Vogel 2012): exponential smoothing whose cutoff
/// frequency rises with the speed of the signal,
///
///     x̂' = (x − x̂) / τ,  τ = 1 / (2π f),  f = cutoff + beta |v̂|
///
/// solved exactly for a signal that goes evenly from sample to sample, so that the result is that of the motion
/// whatever its samples' rate; v̂ is the difference quotient of the raw signal under the fixed cutoff `rate_cutoff`;
/// it starts with the first difference. A vector has one cutoff, from the length of v̂, so a
/// straight path stays straight. At constant speed v the output lies
/// v / (2π (cutoff + beta v)) < 1 / (2π beta) behind, whatever the rate of the samples.
struct OneEuroOptions {
    double cutoff = 1.2;     ///< Hz, at rest
    double beta = 0;         ///< Hz per unit of speed
    double rate_cutoff = 3;  ///< Hz
};

template <class V>
struct OneEuro {
    bool started = false, moved = false;
    double time = 0;
    V raw{}, value{}, rate{};
};

/// The filtered value of the next sample. A time that does not rise counts as 1 ms later.
/// V: double, Vec2 or Vec3.
template <class V>
V filter(OneEuro<V>& state, const V& sample, double time, const OneEuroOptions& options);

/// Rotations: smoothed along the shortest arc, speed in rad/s.
struct OneEuroTurn {
    bool started = false, moved = false;
    double time = 0;
    Quat raw{1, 0, 0, 0}, value{1, 0, 0, 0};
    double rate = 0;  ///< rad/s
};
Quat filter(OneEuroTurn& state, const Quat& sample, double time, const OneEuroOptions& options);

/// Defaults for a hand: white jitter of 0.15 mm per axis (1–2 pixels of a model that fills the
/// screen) loses over nine tenths of its power at rest and three quarters of it at 20 mm/s. A
/// steady drag is never more than 0.53 mm ahead, a steady change of pressure 0.02, of tilt 0.02 rad.
struct HandFilterOptions {
    OneEuroOptions position{.cutoff = 1.2, .beta = 300};  ///< Hz, Hz per m/s
    OneEuroOptions pressure{.cutoff = 2, .beta = 8};      ///< Hz, Hz per 1/s
    OneEuroOptions tilt{.cutoff = 1.5, .beta = 8};        ///< Hz, Hz per rad/s; rotation too
};

/// The defaults with every lag times `strength` (> 0).
HandFilterOptions hand_filter_options(double strength);

struct HandFilter {
    OneEuro<Vec3> position;
    OneEuro<double> pressure;
    OneEuro<Vec2> tilt;
    OneEuro<double> roll;
    OneEuroTurn rotation;
};

/// The next sample, steadied in position, pressure, tilt, roll and rotation; its time stays.
/// Pressure 0 stays 0: the hand is off.
StrokeSample smooth(HandFilter& state, const StrokeSample& sample, const HandFilterOptions& options = {});
brush::Pose smooth(HandFilter& state, const brush::Pose& pose, const HandFilterOptions& options = {});

/// A tip pulled on a string: it stays where it is until the string is taut, then follows
/// straight towards the hand (`drag_string`, exact for a hand that goes straight from sample to sample). |hand − tip| ≤
/// length always, and a wobble of the hand narrower than the string's length leaves the tip at rest.
struct String {
    bool started = false;
    Vec3 tip{0}, hand{0};  ///< metres
    double travel = 0;     ///< metres the hand has gone
    struct Grip {
        double travel = 0;  ///< metres the hand had gone
        double pressure = 0;
        Vec2 tilt{0};
        double roll = 0;
    };
    std::deque<Grip> past;  ///< what the tip has still to come through
};

/// Moves the tip; `length` in metres. The answer has the tip's place, and the pressure, tilt and roll
/// that the hand had |hand − tip| of travel before, so that they stay at their place on the
/// path. A string of length 0 passes everything through as it is.
StrokeSample pull(String& state, const StrokeSample& hand, double length);

/// The hand lets go: the tip runs straight to the hand's last place at `speed` (m/s), in
/// samples of at most `spacing` metres, through what is left of the pressures.
/// Appends them to `out`, times after `time`.
void let_go(String& state, double time, double speed, double spacing, std::vector<StrokeSample>& out);

/// The same for a ferrule in space: the string lies across the holder's axis; press, lift and
/// rotation pass through at once.
brush::Pose pull(String& state, const brush::Pose& hand, double length);

}  // namespace tuft::stroke
