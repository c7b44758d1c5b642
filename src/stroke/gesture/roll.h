#pragma once

#include "core/geometry/types.h"
#include "stroke/journal/entry/samples.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// Roll of the holder: how a wide ferrule turns about its own axis.
///
/// In the axes of flat samples (x to the right, y down) a ferrule with the roll r has its broad side x along
/// (cos r, −sin r) and its y along (−sin r, −cos r). It stands across a path of unit direction m where y = ±m.
///
/// A hand that follows its stroke turns the ferrule towards that. With Δ the angle still left and s the path's length,
///
///     dΔ/ds = −sin(Δ)/λ,    along a straight piece    tan(Δ/2) ← tan(Δ/2) e^(−Δs/λ),
///
/// the angle of a string of length λ to the motion that drags it (the tractrix, see tractrix.h). The pieces between
/// samples are solved exactly, so that a straight path gives the same for any samples, and a curved one to second order
/// in their distance. On a circle of radius R > λ the ferrule lags by a constant angle, sin(Δ) = λ/R.
///
/// Both faces of the ferrule are alike: y leads, or −y where y would have to turn by more than `kOtherFace`. A path
/// that reverses does not spin the holder. A mirrored path has the mirrored roll.
namespace tuft::stroke {

inline constexpr double kRollLag = 5e-3;      ///< λ, metres
inline constexpr double kOtherFace = 2.3562;  ///< radians, 3π/4: a larger turn is left to the other face

/// Returns the roll at the part t, 0–1, of the shortest turn from a to b, radians.
double mix_roll(double a, double b, double t);

/// A holder that follows its stroke, sample by sample.
struct RollFollower {
    bool started = false;
    double roll = 0;  ///< radians, of the ferrule
    double hand = 0;  ///< radians, as the hand held it at the last sample
    int face = 1;     ///< −1: −y leads
};

/// Returns the roll after the next sample. `hand`: radians, the roll that the hand itself gives, such as that of a pen
/// about itself. `motion`: metres, from the last sample to this one in the axes of flat samples. The first sample's
/// roll is the hand's. A turn of the hand adds to the roll evenly along the path, and is lost again as the ferrule goes
/// on.
double follow_stroke(RollFollower& state, double hand, const Vec2& motion);

/// Roll of a blade in a hand that turns. A blade lies along the hair that it drags, so it turns as late as the end of a
/// string of length λ. Without that lag its line is wider in one bend than in the other. With e the lag of the roll r
/// over the path s,
///
///     de/ds = dr/ds − e/λ,
///
/// exact for rolls that are linear between samples. A turn in place is not late; none lags by more than 0.2 radians.
class BladeRoll {
  public:
    /// `string`: λ, metres. `hand`: radians, roll of the hand at the first sample.
    BladeRoll(double string, double hand) : string_(string), hand_(hand) {}
    /// Takes the next sample, `gone` metres along the path.
    void follow(double hand, double gone);
    double roll() const { return hand_ - late_; }

  private:
    double string_, hand_, late_ = 0;
};

/// Returns the trace with the rolls that `roll` and `roll_follow` of the settings give to its samples. A trace in space
/// stays as it is.
StrokeSamples roll_holder(StrokeSamples trace, const StrokeSettings& settings);

}  // namespace tuft::stroke
