#include "stroke/gesture/hand_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/first_order_lag.h"
#include "stroke/gesture/roll.h"
#include "stroke/gesture/tractrix.h"

namespace tuft::stroke {
namespace {

constexpr double kShortestStep = 1e-3;  // seconds; what a time that does not rise counts as

double time_constant(double cutoff) {
    return 1 / (2 * std::numbers::pi * cutoff);
}

// Part of the distance to a constant goal that a low-pass goes in dt.
double share(double cutoff, double dt) {
    return settled_part(dt, time_constant(cutoff));
}

// A low-pass y of a signal that goes evenly from x0 to x1 in dt, solved exactly: y' = (x - y) / τ.
template <class V>
V low_pass(const V& y, const V& x0, const V& x1, double dt, double cutoff) {
    const double tau = time_constant(cutoff);
    const V lag = (tau / dt) * (x1 - x0);
    return x1 - lag + std::exp(-dt / tau) * (y - x0 + lag);
}

double size(double v) {
    return std::abs(v);
}
double size(const Vec2& v) {
    return glm::length(v);
}
double size(const Vec3& v) {
    return glm::length(v);
}

// Time of the next sample; rises always.
double next_time(double before, double time) {
    return time > before ? time : before + kShortestStep;
}

// Rotation vector, radians, and back.
Vec3 turn_of(const Quat& q) {
    const Vec3 v{q.x, q.y, q.z};
    const double sine = glm::length(v);
    return sine > 0 ? (q.w < 0 ? -2.0 : 2.0) * std::atan2(sine, std::abs(q.w)) / sine * v : Vec3{0};
}
Quat rotation_by(const Vec3& turn) {
    const double angle = glm::length(turn);
    return angle > 0 ? glm::angleAxis(angle, turn / angle) : Quat{1, 0, 0, 0};
}

String::Grip grip_at(String& state, double travel) {
    auto& past = state.past;
    while (past.size() > 1 && past[1].travel <= travel) past.pop_front();
    if (past.size() == 1 || past[0].travel >= travel) return past.front();
    const double w = (travel - past[0].travel) / (past[1].travel - past[0].travel);
    return {travel, past[0].pressure + w * (past[1].pressure - past[0].pressure),
            past[0].tilt + w * (past[1].tilt - past[0].tilt), mix_roll(past[0].roll, past[1].roll, w)};
}

}  // namespace

template <class V>
V filter(OneEuro<V>& s, const V& sample, double time, const OneEuroOptions& o) {
    if (!s.started) {
        s = {.started = true, .moved = false, .time = time, .raw = sample, .value = sample, .rate = V(0)};
        return sample;
    }
    time = next_time(s.time, time);
    const double dt = time - s.time;
    const V rate = (sample - s.raw) / dt;
    s.rate = s.moved ? s.rate + share(o.rate_cutoff, dt) * (rate - s.rate) : rate;
    s.moved = true;
    s.value = low_pass(s.value, s.raw, sample, dt, o.cutoff + o.beta * size(s.rate));
    s.raw = sample;
    s.time = time;
    return s.value;
}

template double filter(OneEuro<double>&, const double&, double, const OneEuroOptions&);
template Vec2 filter(OneEuro<Vec2>&, const Vec2&, double, const OneEuroOptions&);
template Vec3 filter(OneEuro<Vec3>&, const Vec3&, double, const OneEuroOptions&);

Quat filter(OneEuroTurn& s, const Quat& sample, double time, const OneEuroOptions& o) {
    if (!s.started) {
        s = {.started = true, .moved = false, .time = time, .raw = sample, .value = sample, .rate = 0};
        return sample;
    }
    time = next_time(s.time, time);
    const double dt = time - s.time;
    // In the tangent space at the sample.
    const Vec3 before = turn_of(glm::conjugate(sample) * s.raw), value = turn_of(glm::conjugate(sample) * s.value);
    const double rate = glm::length(before) / dt;
    s.rate = s.moved ? s.rate + share(o.rate_cutoff, dt) * (rate - s.rate) : rate;
    s.moved = true;
    const Vec3 left = low_pass(value, before, Vec3{0}, dt, o.cutoff + o.beta * s.rate);
    s.value = glm::normalize(sample * rotation_by(left));
    s.raw = sample;
    s.time = time;
    return s.value;
}

HandFilterOptions hand_filter_options(double strength) {
    HandFilterOptions o;
    for (OneEuroOptions* part : {&o.position, &o.pressure, &o.tilt}) {
        part->cutoff /= strength;
        part->beta /= strength;
    }
    return o;
}

StrokeSample smooth(HandFilter& s, const StrokeSample& sample, const HandFilterOptions& o) {
    StrokeSample out = sample;
    out.position = filter(s.position, sample.position, sample.time, o.position);
    out.tilt = filter(s.tilt, sample.tilt, sample.time, o.tilt);
    out.roll = filter(s.roll, mix_roll(s.roll.raw, sample.roll, 1), sample.time, o.tilt);  // past ±π it goes on
    out.rotation = filter(s.rotation, sample.rotation, sample.time, o.tilt);
    out.pressure = filter(s.pressure, sample.pressure, sample.time, o.pressure);
    if (!(sample.pressure > 0)) out.pressure = sample.pressure;
    return out;
}

brush::Pose smooth(HandFilter& s, const brush::Pose& pose, const HandFilterOptions& o) {
    return {.position = filter(s.position, pose.position, pose.time, o.position),
            .rotation = filter(s.rotation, pose.rotation, pose.time, o.tilt),
            .time = pose.time};
}

StrokeSample pull(String& s, const StrokeSample& hand, double length) {
    if (!s.started) {
        s = {};
        s.started = true;
        s.tip = s.hand = hand.position;
    }
    s.travel += glm::length(hand.position - s.hand);
    s.tip = drag_string(s.tip, s.hand, hand.position, length);
    s.hand = hand.position;
    // Of a hand that rests the first and the last are enough.
    const std::size_t n = s.past.size();
    if (n >= 2 && s.past[n - 2].travel == s.travel && s.past[n - 1].travel == s.travel) s.past.pop_back();
    s.past.push_back({s.travel, hand.pressure, hand.tilt, hand.roll});
    const String::Grip grip = grip_at(s, s.travel - glm::distance(s.tip, s.hand));
    StrokeSample out = hand;
    out.position = s.tip;
    out.pressure = grip.pressure;
    out.tilt = grip.tilt;
    out.roll = grip.roll;
    return out;
}

void let_go(String& s, double time, double speed, double spacing, std::vector<StrokeSample>& out) {
    if (!s.started || s.past.empty()) return;
    const Vec3 start = s.tip;
    const double moved = glm::length(s.hand - start);
    if (!(moved > 0) || !(speed > 0) || !(spacing > 0)) return;
    const int steps = std::max(1, static_cast<int>(std::min(std::ceil(moved / spacing), 1e5)));
    for (int i = 1; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        s.tip = start + part * (s.hand - start);
        const String::Grip grip = i == steps ? s.past.back() : grip_at(s, s.travel - (1 - part) * moved);
        out.push_back({.time = time + part * moved / speed,
                       .position = s.tip,
                       .pressure = grip.pressure,
                       .tilt = grip.tilt,
                       .roll = grip.roll,
                       .rotation = {1, 0, 0, 0}});
    }
}

brush::Pose pull(String& s, const brush::Pose& hand, double length) {
    if (!s.started) {
        s = {};
        s.started = true;
        s.tip = s.hand = hand.position;
    }
    const Vec3 axis = hand.axis();
    const auto level = [&](const Vec3& p) { return p + glm::dot(hand.position - p, axis) * axis; };
    s.tip = drag_string(level(s.tip), level(s.hand), hand.position, length);
    s.hand = hand.position;
    return {.position = s.tip, .rotation = hand.rotation, .time = hand.time};
}

}  // namespace tuft::stroke
