#include "writer/fit/brush_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/hat.h"
#include "stroke/placement/tip_lag.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

constexpr double kBlunt = 12;       // units of half width from which an end is blunt
constexpr double kLiftTime = 0.03;  // seconds from the last ink to the free tip
constexpr double kTouchReach = 16;  // units about the first station whose width bounds the touch
constexpr int kTouchSamples = 9;
constexpr double kUpright = 1e-9;  // radians: no lean that a hand can see

/// Curvature at a station from its neighbours two stations away, 1/units.
double curvature(std::span<const Station> s, std::size_t i) {
    const std::size_t a = i - std::min<std::size_t>(i, 2), b = std::min(s.size() - 1, i + 2);
    const Vec2 in = s[i].centre - s[a].centre, on = s[b].centre - s[i].centre;
    const double length = 0.5 * (glm::length(in) + glm::length(on));
    if (!(length > 1e-9) || a == i || b == i) return 0;
    return std::abs(std::atan2(in.x * on.y - in.y * on.x, glm::dot(in, on))) / length;
}

double pressure_of(double half, const BrushHand& hand) {
    const double width = 2 * half * hand.unit, least = hand.widths.least();
    if (width >= least) return hand.widths.pressure(width);
    return stroke::LineWidths::kLightest * std::max(width, 0.0) / least;
}

/// Samples of the touch across the path before its first station, earlier in time. Empty without `pace.across`.
std::vector<stroke::StrokeSample> touch_of(std::span<const Station> s, const BrushHand& hand, const Pace& pace) {
    std::vector<stroke::StrokeSample> touch;
    const Vec2 on = s[std::min<std::size_t>(2, s.size() - 1)].centre - s[0].centre;
    const double length = glm::length(on);
    if (!(pace.across > 0 && length > 1e-9)) return touch;
    const Vec2 left = Vec2(-on.y, on.x) / length;
    double half = 0;
    for (std::size_t i = 0; i < s.size() && glm::distance(s[i].centre, s[0].centre) <= kTouchReach; ++i)
        half = std::max(half, s[i].half);
    const double pressure = std::min(pace.touch, pressure_of(half, hand));
    const double across_time = pace.across * hand.unit / (pace.speed * pace.ends);
    for (int k = 0; k < kTouchSamples; ++k) {
        const double aside = 1 - 2.0 * k / (kTouchSamples - 1);  // from the left to the right
        const Vec2 at = hand.unit * (s[0].centre + aside * pace.across * left);
        // At the right end it has as far to go to the first station as from the middle.
        touch.push_back({.time = -(2 + aside) * across_time, .position = {at.x, -at.y, 0}, .pressure = pressure});
    }
    return touch;
}

/// Tilt at each station of a holder that is held as its make is.
std::vector<Vec2> make_tilts(std::span<const Station> stations, const BrushHand& hand, double roll) {
    std::vector<Vec2> tilts(stations.size(), Vec2(0));
    if (!(hand.hold.lean > 0)) return tilts;
    stroke::StrokeSamples trace;
    for (const Station& s : stations)
        trace.samples.push_back({.position = {s.centre.x * hand.unit, -s.centre.y * hand.unit, 0}, .roll = roll});
    trace = stroke::lean_holder(std::move(trace), hand.hold);
    for (std::size_t i = 0; i < tilts.size(); ++i) tilts[i] = trace.samples[i].tilt;
    return tilts;
}

/// Means within `reach` units, nearer ones weigh more.
std::vector<Vec2> blended(const std::vector<Vec2>& own, std::span<const double> along, double reach) {
    std::vector<Vec2> out(own.size(), Vec2(0));
    for (std::size_t i = 0; i < own.size(); ++i) {
        double all = 0;
        for (std::size_t k = 0; k < own.size(); ++k) {
            const double weight = hat(along[k] - along[i], std::max(reach, 1.0));
            out[i] += weight * own[k], all += weight;
        }
        out[i] /= all;
    }
    return out;
}

/// Tilt of the holder at each station, radians to the right and down.
std::vector<Vec2> tilts_of(std::span<const Station> stations, std::span<const double> along, const BrushHand& hand,
                           const Pace& pace) {
    std::vector<Vec2> none(stations.size(), Vec2(0));
    if (pace.lean.empty() || stations.size() < 2 || !(along.back() > 1e-9)) return none;
    std::vector<Vec2> centres;
    for (const Station& s : stations) centres.push_back(s.centre);
    const StrokeLine line = make_stroke_line(centres);
    std::vector<Vec2> own = make_tilts(stations, hand, pace.roll);
    bool named = false;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double there = along[i] / along.back() * line.length();
        std::size_t s = 0;
        while (s + 1 < line.segments.size() && there > line.along[line.segments[s].last]) ++s;
        const auto lean = pace.lean.find(line.segments[s].code);
        if (lean == pace.lean.end()) continue;
        const Vec2 d = line.direction(there);
        own[i] = lean->second * Vec2(-d.x, d.y);
        named = true;
    }
    if (!named) return none;
    std::vector<Vec2> tilts = blended(own, along, pace.ease);
    // Upright all the way, and meant so: a make leans where no sample says otherwise (`stroke::lean_holder`).
    if (hand.hold.lean > 0 && std::ranges::all_of(tilts, [](const Vec2& t) { return t == Vec2(0); }))
        tilts.front().x = kUpright;
    return tilts;
}

}  // namespace

stroke::StrokeSamples samples_of(std::span<const Station> stations, const BrushHand& hand, const Pace& pace) {
    stroke::StrokeSamples trace;
    std::vector<double> along{0};
    for (std::size_t i = 1; i < stations.size(); ++i)
        along.push_back(along.back() + glm::distance(stations[i].centre, stations[i - 1].centre));
    const std::size_t near_end = stations.size() - std::min<std::size_t>(stations.size(), 4);
    const bool blunt = stations[near_end].half > kBlunt;
    const std::vector<Vec2> tilts = tilts_of(stations, along, hand, pace);
    double time = 0;
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const double bend = std::max(curvature(stations, i) * pace.radius, 1.0);
        double near = along[i];
        if (blunt) near = std::min(near, along.back() - along[i]);
        const double ease = std::lerp(pace.ends, 1.0, std::clamp(near / pace.ease, 0.0, 1.0));
        const double speed = pace.speed / std::cbrt(bend) * ease;
        if (i > 0) time += (along[i] - along[i - 1]) * hand.unit / speed;
        trace.samples.push_back({.time = time,
                                 .position = {stations[i].centre.x * hand.unit, -stations[i].centre.y * hand.unit, 0},
                                 .pressure = pressure_of(stations[i].half, hand),
                                 .tilt = tilts[i]});
    }
    if (const std::vector<stroke::StrokeSample> touch = touch_of(stations, hand, pace); !touch.empty()) {
        trace.samples.insert(trace.samples.begin(), touch.begin(), touch.end());
        const double begin = touch.front().time;
        for (stroke::StrokeSample& sample : trace.samples) sample.time -= begin;
        for (std::size_t i = 0; i < touch.size(); ++i) trace.samples[i].tilt = tilts.front();
    }
    for (stroke::StrokeSample& sample : trace.samples) sample.roll = pace.roll;
    stroke::StrokeSample last = trace.samples.back();
    last.time += kLiftTime;
    last.pressure = 0;
    trace.samples.push_back(last);
    return trace;
}

}  // namespace tuft::writer
