#include "stroke/hand/hand_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::stroke {
namespace {

constexpr double kShortestStep = 1e-3;  // seconds; what a time that does not rise counts as

double weight(double cutoff, double dt) {
    const double tau = 1 / (2 * std::numbers::pi * cutoff);
    return dt / (dt + tau);
}

double size(double v) { return std::abs(v); }
double size(const Vec2& v) { return glm::length(v); }
double size(const Vec3& v) { return glm::length(v); }

// Time of the next sample; rises always.
double next_time(double before, double time) {
    return time > before ? time : before + kShortestStep;
}

// Moves the tip behind the hand; returns the length of the string in use.
double drag(Vec3& tip, const Vec3& hand, double length) {
    const Vec3 string = hand - tip;
    const double reach = glm::length(string);
    if (reach <= length) return reach;
    tip = hand - string * (length / reach);
    return length;
}

String::Grip grip_at(String& state, double travel) {
    auto& past = state.past;
    while (past.size() > 1 && past[1].travel <= travel) past.pop_front();
    if (past.size() == 1 || past[0].travel >= travel) return past.front();
    const double w = (travel - past[0].travel) / (past[1].travel - past[0].travel);
    return {travel, past[0].pressure + w * (past[1].pressure - past[0].pressure),
            past[0].tilt + w * (past[1].tilt - past[0].tilt)};
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
    s.rate = s.moved ? s.rate + weight(o.rate_cutoff, dt) * (rate - s.rate) : rate;
    s.moved = true;
    s.value += weight(o.cutoff + o.beta * size(s.rate), dt) * (sample - s.value);
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
    const Quat turn = glm::conjugate(s.raw) * sample;
    const double angle = 2 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
    s.rate = s.moved ? s.rate + weight(o.rate_cutoff, dt) * (angle / dt - s.rate) : angle / dt;
    s.moved = true;
    s.value = glm::normalize(glm::slerp(s.value, sample, weight(o.cutoff + o.beta * s.rate, dt)));
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

TraceSample smooth(HandFilter& s, const TraceSample& sample, const HandFilterOptions& o) {
    TraceSample out = sample;
    out.position = filter(s.position, sample.position, sample.time, o.position);
    out.tilt = filter(s.tilt, sample.tilt, sample.time, o.tilt);
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

TraceSample pull(String& s, const TraceSample& hand, double length) {
    if (!s.started) {
        s = {};
        s.started = true;
        s.tip = s.hand = hand.position;
    }
    s.travel += glm::length(hand.position - s.hand);
    s.hand = hand.position;
    s.past.push_back({s.travel, hand.pressure, hand.tilt});
    const double behind = drag(s.tip, hand.position, length);
    const String::Grip grip = grip_at(s, s.travel - behind);
    TraceSample out = hand;
    out.position = s.tip;
    out.pressure = grip.pressure;
    out.tilt = grip.tilt;
    return out;
}

void let_go(String& s, double time, double speed, double spacing, std::vector<TraceSample>& out) {
    if (!s.started || s.past.empty()) return;
    const Vec3 start = s.tip;
    const double way = glm::length(s.hand - start);
    if (!(way > 0) || !(speed > 0) || !(spacing > 0)) return;
    const int steps = std::max(1, static_cast<int>(std::min(std::ceil(way / spacing), 1e5)));
    for (int i = 1; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        s.tip = start + part * (s.hand - start);
        const String::Grip grip =
            i == steps ? s.past.back() : grip_at(s, s.travel - (1 - part) * way);
        out.push_back({.time = time + part * way / speed,
                       .position = s.tip,
                       .pressure = grip.pressure,
                       .tilt = grip.tilt,
                       .rotation = {1, 0, 0, 0}});
    }
}

brush::Pose pull(String& s, const brush::Pose& hand, double length) {
    if (!s.started) {
        s = {};
        s.started = true;
        s.tip = s.hand = hand.position;
    }
    s.hand = hand.position;
    const Vec3 axis = hand.axis();
    s.tip += glm::dot(hand.position - s.tip, axis) * axis;
    drag(s.tip, hand.position, length);
    return {.position = s.tip, .rotation = hand.rotation, .time = hand.time};
}

}  // namespace tuft::stroke
