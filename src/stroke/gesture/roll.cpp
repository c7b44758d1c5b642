#include "stroke/gesture/roll.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::stroke {
namespace {

using std::numbers::pi;

/// The shortest turn from a to b, radians.
double turn_between(double a, double b) {
    return std::remainder(b - a, 2 * pi);
}

}  // namespace

double mix_roll(double a, double b, double t) {
    return a + t * turn_between(a, b);
}

double follow_stroke(RollFollower& state, double hand, const Vec2& motion) {
    if (!state.started) {
        state = {.started = true, .roll = hand, .hand = hand};
        return hand;
    }
    const double twist = turn_between(state.hand, hand);
    state.hand = hand;
    state.roll += 0.5 * twist;
    if (const double length = glm::length(motion); length > 0) {
        const Vec2 ahead = static_cast<double>(state.face) * motion;
        double left = turn_between(state.roll, std::atan2(-ahead.x, -ahead.y));
        if (std::abs(left) > kOtherFace) {
            state.face = -state.face;
            left = std::remainder(left + pi, 2 * pi);
        }
        state.roll += left - 2 * std::atan(std::tan(0.5 * left) * std::exp(-length / kRollLag));
    }
    return state.roll += 0.5 * twist;
}

void BladeRoll::follow(double hand, double gone) {
    constexpr double kMostLate = 0.2;  // radians
    const double turned = turn_between(hand_, hand);
    hand_ = hand;
    if (!(gone > 0)) return;
    const double steady = std::clamp(turned / gone * string_, -kMostLate, kMostLate);
    late_ = steady + (late_ - steady) * std::exp(-gone / string_);
}

StrokeSamples roll_holder(StrokeSamples trace, const StrokeSettings& settings) {
    if (!trace.flat || (settings.roll == 0 && !settings.roll_follow)) return trace;
    RollFollower follower;
    Vec3 before{0};
    for (StrokeSample& s : trace.samples) {
        const Vec2 motion = follower.started ? Vec2(s.position - before) : Vec2{0};
        before = s.position;
        if (settings.roll_follow) s.roll = follow_stroke(follower, s.roll, motion);
        s.roll += settings.roll;
    }
    return trace;
}

}  // namespace tuft::stroke
