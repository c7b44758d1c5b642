#include "stroke/placement/turn_back.h"

#include <algorithm>
#include <cmath>

#include "core/ease.h"
#include "stroke/gesture/tractrix.h"

namespace tuft::stroke {
namespace {

constexpr double kLifted = 0.4;         // of the string's length: in a reversal the hair is in the air below it
constexpr double kLiftedPart = 0.06;    // of what the string becomes shorter in a turn: over that it is in the air
constexpr double kLeansOver = 5.0 / 6;  // of what it is longer than that: the hand begins to lean to the other side
constexpr double kTaut = 1 - 1e-9;

Vec3 in_plane(const StrokeSample& s) {
    return {s.position.x, s.position.y, 0};
}

constexpr double kTremor = 0.05;  // of λ: motions that turn nothing

/// Radians; 0 where one of them is zero.
double angle_between(const Vec3& a, const Vec3& b) {
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0 ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) : 0;
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

void Turn::begin(const Vec3& position, const Vec3& string) {
    *this = {};
    before_ = string, from_ = position;
}

void Turn::follow(const Vec3& position, const Vec3& string, double length) {
    const Vec3 motion = position - from_;
    const double gone = glm::length(motion);
    if (gone < kTremor * length) return;
    from_ = position;
    const Vec3 ahead = motion / gone;
    const double along = glm::dot(string, ahead);
    turn_ = std::max(turn_, angle_between(before_, ahead));
    shortest_ = std::min(shortest_, glm::length(along < 0 ? string - along * ahead : string));
}

TurnLift Turn::lift(const LiftedTurns& lifted) const {
    return {.back = smooth_step((turn_ - lifted.least) / (lifted.whole - lifted.least)),
            .air = std::max(kLifted, std::lerp(shortest_, 1.0, kLiftedPart))};
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
        if (!(glm::length(out[i].towards) < kTaut)) continue;
        const std::size_t begin = i > 0 ? i - 1 : 0;
        Turn turn;
        turn.begin(in_plane(samples[begin]), Vec3(out[begin].towards, 0));
        std::size_t end = i;
        for (; end < out.size() && glm::length(out[end].towards) < kTaut; ++end)
            turn.follow(in_plane(samples[end]), Vec3(out[end].towards, 0), string);
        // Of a path that goes on, the motion that draws the string taut again.
        if (end < out.size()) turn.follow(in_plane(samples[end]), Vec3(out[end].towards, 0), string);
        for (; i < end; ++i) out[i].lift = turn.lift(kLiftedTurns);
    }
    return out;
}

void TurnFollower::follow(const Vec3& position, const Vec3& string, double length, const LiftedTurns& lifted) {
    const double taut = glm::length(string);
    since_turn_ += started_ ? glm::distance(position, last_) : 0;
    last_ = position;
    if (!started_ || taut >= kTaut) {
        turn_.begin(position, string);
        started_ = true;
        lift_ = {};
        return;
    }
    turn_.follow(position, string, length);
    lift_ = turn_.lift(lifted);
    if (lift_.back > 0 && taut < lift_.air) since_turn_ = 0, turned_back_ = lift_.back;
}

}  // namespace tuft::stroke
