#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "core/text/units.h"
#include "stroke/journal/entry/samples.h"
#include "stroke/placement/placement.h"

/// \file
/// Lift of a wide ferrule where its path turns back. Called by tip_lag.h for recorded samples, and by
/// stroke/pointer/pointer_input.h for a hand whose next sample nobody knows.
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

/// Returns the lift of a turn by `turn` radians, in which the string becomes as short as `shortest`. In a turn by less
/// than 168° the string stays longer than 0.2; the hair is in the air over the last quarter of what it becomes shorter.
TurnLift turn_lift(double turn, double shortest, const LiftedTurns& lifted = kLiftedTurns);

/// Where a recorded hand is in a turn.
struct Turning {
    Vec2 towards{0};  ///< the string, from its end to the hand; a unit vector ahead where it is taut
    TurnLift lift;
};

/// Returns the turning at each sample. `string`: λ, metres. `ahead`: unit, direction in which the trace sets out;
/// `lifted`: whether a turn lifts the hair. Cost: linear.
std::vector<Turning> find_turnings(std::span<const StrokeSample> samples, double string, const Vec2& ahead,
                                   bool lifted);

/// A hand that turns while nobody knows its next sample. The path is taken to go on straight.
class TurnFollower {
  public:
    /// Takes the next place of the hand, metres, and its string there, over λ.
    void follow(const Vec3& position, const Vec3& string, const LiftedTurns& lifted);
    const TurnLift& lift() const { return lift_; }
    /// Returns the metres that the hand has gone since the hair was last in the air, and how much it turned back there.
    double since_turn() const { return since_turn_; }
    double turned_back() const { return turned_back_; }

  private:
    bool started_ = false;
    Vec3 before_{0}, from_{0};  // string and place where it was last taut
    Vec3 last_{0};              // the last place
    double since_turn_ = 1e9, turned_back_ = 0;
    TurnLift lift_;
};

}  // namespace tuft::stroke
