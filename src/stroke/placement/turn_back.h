#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "core/text/units.h"
#include "stroke/journal/entry/samples.h"
#include "stroke/placement/placement.h"

/// \file
/// Lift of a wide ferrule where its path turns back, and of a toe where its stroke ends. Called by tip_lag.h for
/// recorded samples, and by stroke/pointer/pointer_input.h for a hand whose next sample nobody knows.
///
/// Hair that is pushed before the hand lies on ahead of it for centimetres, then falls along its row. The hand lifts
/// it, carries it over and sets it down to its other side. Where it is in the turn says a string of length λ, on which
/// a point is dragged behind it: it is slack there, and becomes shorter the more the path turns back.
namespace tuft::stroke {

/// Whether the hand lifts a brush where its path turns back: a wide ferrule.
bool is_lifted_at_turns(const HolderOptions& options);

/// Lift in one turn of a path. Lengths of the string are over λ, 1 where it is taut.
struct TurnLift {
    double back = 0;   ///< 0–1: how much the path turns back, and the hair is lifted
    double air = 0.4;  ///< length of the string below which it is in the air

    /// Returns how much of its pressure hair has at that length of the string, 0–1.
    double pressed(double taut) const;
    /// Returns how high it is carried there, 0–1.
    double carried(double taut) const;
    /// Returns how far the hand leans to the other side there, 0–1.
    double leans_over(double taut) const;
};

/// Turns of a path, radians: the greatest that lifts no hair, and the least that lifts it all.
struct LiftedTurns {
    double least, whole;
};
/// Of a hand that leads its ink by the tip lag: pushed hair stands out beside a corner of 120° by 1 mm, of 150° by 2
/// mm.
inline constexpr LiftedTurns kLiftedTurns{100 * kDegree, 115 * kDegree};
/// Of a pen: its hair trails, comes round corners, and springs forward under the pen as it is lifted.
inline constexpr LiftedTurns kLiftedPenTurns{145 * kDegree, 160 * kDegree};

/// A turn of a path, along which the string is slack, place by place of the hand.
class Turn {
  public:
    /// The string was last taut at `position`, metres; `string`: from its end to the hand, over λ.
    void begin(const Vec3& position, const Vec3& string);
    /// Takes the next place. `length`: λ, metres.
    void follow(const Vec3& position, const Vec3& string, double length);
    /// Returns the lift by the greatest turn up to here, from the string's direction at the beginning, and by the
    /// shortest that the string became or becomes if the path goes on straight. Motions shorter than λ/20 are tremor
    /// and turn nothing. In a turn by less than 158° the string stays longer than 0.36; the hair is in the air where
    /// the string is within 0.06 (1 − its shortest) of its shortest.
    TurnLift lift(const LiftedTurns& lifted) const;

  private:
    Vec3 before_{0}, from_{0};
    double turn_ = 0, shortest_ = 1;
};

/// Where a recorded hand is in a turn.
struct Turning {
    Vec2 towards{0};  ///< the string, from its end to the hand; a unit vector ahead where it is taut
    TurnLift lift;
};

/// Returns the turning at each sample. `string`: λ, metres. `ahead`: unit, direction in which the trace sets out;
/// `lifted`: whether a turn lifts the hair. Cost: linear.
std::vector<Turning> find_turnings(std::span<const StrokeSample> samples, double string, const Vec2& ahead,
                                   bool lifted);

/// One sample of a hand that leads its ink by the tip lag.
struct TipLagSample {
    Vec2 ahead{0};     ///< direction of the path, up to 1 long
    double along = 0;  ///< metres of path up to here
    double depth = 0;  ///< metres of the unbent tip below the surface
    double turn = 0;   ///< radians, of the ferrule's x from the path
    Vec2 tip_lag{0};   ///< metres, in the axes of `ahead`
};

/// Shortens the tip lags of a ferrule with a toe, of other brushes none, where the hand would go back as it lifts. Hair
/// springs forward as it is lifted and leaves under the hand: that of a toe all at one place, in a square end. Where
/// the toe is lifted on its broad side, in a path that turns by less than 14 to 26°, the part λ along the path falls to
///
///     λ(s) = min over s' ≥ s of λ(s') + (s' − s) − toe_end/toe · (what of the toe is lifted from s to s'),
///
/// so that the hand does not go back, and goes on by `toe_end` while it lifts the toe: the edges leave first, and the
/// stroke ends round. In a bend a hand that waits would turn the hair about itself. Cost: linear.
void shorten_tip_lag_at_end(std::span<TipLagSample> samples, const HolderOptions& options);

/// A hand that turns while nobody knows its next sample: lifted by what is known of the turn.
class TurnFollower {
  public:
    /// Takes the next place of the hand, metres, and its string there, over λ, `length` metres.
    void follow(const Vec3& position, const Vec3& string, double length, const LiftedTurns& lifted);
    const TurnLift& lift() const { return lift_; }
    /// Returns the metres that the hand has gone since the hair was last in the air, and how much it turned back there.
    double since_turn() const { return since_turn_; }
    double turned_back() const { return turned_back_; }

  private:
    bool started_ = false;
    Turn turn_;
    Vec3 last_{0};  // the last place
    double since_turn_ = 1e9, turned_back_ = 0;
    TurnLift lift_;
};

}  // namespace tuft::stroke
