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

// Sine of a toe's turn from its path up to which it is on its edge, and from which on its broad side is across.
constexpr double kEdgeOn = 0.3, kBroadOn = 0.8;
// Cosine of the turn of a path beyond which a hand that lifts a toe does not wait, and up to which it does; of that
// between two samples, from which on it goes back.
constexpr double kBends = 0.9, kIsStraight = 0.97, kSameWay = 0.7;

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

void shorten_tip_lag_at_end(std::span<TipLagSample> samples, const HolderOptions& options) {
    if (!(options.toe > 0) || !options.turned) return;
    const std::size_t n = samples.size();
    const auto direction = [&](std::size_t i) {
        const double taut = glm::length(samples[i].ahead);
        return taut > 1e-9 ? samples[i].ahead / taut : Vec2{0};
    };
    const auto of_toe = [&](std::size_t i) { return std::min(samples[i].depth, options.toe); };
    const double round = options.toe_end / options.toe;
    std::vector<double> own(n), most(n);  // metres along the path, of each tip lag and its bound
    for (std::size_t i = n; i-- > 0;) {
        own[i] = most[i] = glm::dot(samples[i].tip_lag, direction(i));
        if (i + 1 == n || glm::dot(direction(i), direction(i + 1)) < kSameWay) continue;
        const double gone = samples[i + 1].along - samples[i].along, lifted = of_toe(i) - of_toe(i + 1);
        most[i] = std::min(most[i], most[i + 1] + gone - std::max(0.0, round * lifted));
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (!(most[i] < own[i])) continue;
        std::size_t end = i;
        double across = 1;
        for (; end < n && most[end] < own[end]; ++end) across = std::min(across, std::abs(std::sin(samples[end].turn)));
        const double part = smooth_step((across - kEdgeOn) / (kBroadOn - kEdgeOn)) *
                            smooth_step((glm::dot(direction(i), direction(end - 1)) - kBends) / (kIsStraight - kBends));
        for (; i < end; ++i) samples[i].tip_lag += part * (most[i] - own[i]) * direction(i);
    }
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
