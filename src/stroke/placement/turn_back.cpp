#include "stroke/placement/turn_back.h"

#include <algorithm>
#include <cmath>

#include "core/ease.h"
#include "stroke/gesture/tractrix.h"

namespace tuft::stroke {
namespace {

constexpr double kLifted = 0.4;         // of the string's length: in a reversal the hair is in the air below it
constexpr double kLiftedPart = 0.25;    // of what the string becomes shorter in a turn: over that it is in the air
constexpr double kLeansOver = 5.0 / 6;  // of what it is longer than that: the hand begins to lean to the other side
constexpr double kTaut = 1 - 1e-9;

/// Radians; 0 where one of them is zero.
template <class V>
double angle_between(const V& a, const V& b) {
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0 ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

/// Motion that ends at a sample, the last one that is none; zero before the path sets out.
Vec2 motion_into(std::span<const StrokeSample> samples, std::size_t i) {
    for (; i > 0; --i)
        if (const Vec2 motion(samples[i].position - samples[i - 1].position); motion != Vec2(0)) return motion;
    return Vec2{0};
}

}  // namespace

bool is_lifted_at_turns(const HolderOptions& options) {
    return options.across || options.turned || options.blade_landing > 0;
}

double TurnLift::pressed(double taut) const {
    return std::lerp(1.0, smooth_step((taut - air) / (1 - air)), back);
}

double TurnLift::carried(double taut) const {
    return back * smooth_step(1 - taut / air);
}

double TurnLift::leans_over(double taut) const {
    return back * smooth_step(1 - (taut - air) / (kLeansOver * (1 - air)));
}

TurnLift turn_lift(double turn, double shortest, const LiftedTurns& lifted) {
    return {.back = smooth_step((turn - lifted.least) / (lifted.whole - lifted.least)),
            .air = std::max(kLifted, std::lerp(shortest, 1.0, kLiftedPart))};
}

std::vector<Turning> find_turnings(std::span<const StrokeSample> samples, double string, const Vec2& ahead,
                                   bool lifted) {
    std::vector<Turning> out;
    out.reserve(samples.size());
    Vec2 before(samples.front().position), dragged = before - string * ahead;
    for (const StrokeSample& s : samples) {
        const Vec2 p(s.position);
        dragged = drag_string(dragged, before, p, string);
        before = p;
        out.push_back({.towards = (p - dragged) / string, .lift = {}});
    }
    if (!lifted) return out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        double least = 1;
        std::size_t end = i;
        for (; end < out.size() && glm::length(out[end].towards) < kTaut; ++end)
            least = std::min(least, glm::length(out[end].towards));
        if (end == i) continue;
        // The path turns from the string's direction before the turn to the motion at its end.
        const Vec2 from = out[i > 0 ? i - 1 : 0].towards, to = motion_into(samples, std::min(end, out.size() - 1));
        const TurnLift lift = turn_lift(angle_between(from, to), least);
        for (; i < end; ++i) out[i].lift = lift;
    }
    return out;
}

void TurnFollower::follow(const Vec3& position, const Vec3& string, const LiftedTurns& lifted) {
    const double taut = glm::length(string);
    since_turn_ += started_ ? glm::distance(position, last_) : 0;
    last_ = position;
    if (!started_ || taut >= kTaut) {
        before_ = string, from_ = position;
        started_ = true;
        lift_ = {};
        return;
    }
    const Vec3 gone = position - from_;
    const double length = glm::length(gone);
    if (!(length > 0)) return;
    const Vec3 ahead = gone / length;
    const double least = glm::length(string - glm::dot(string, ahead) * ahead);
    lift_ = turn_lift(angle_between(before_, ahead), std::min(least, taut), lifted);
    if (lift_.back > 0 && taut < lift_.air) since_turn_ = 0, turned_back_ = lift_.back;
}

}  // namespace tuft::stroke
