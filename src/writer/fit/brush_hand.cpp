#include "writer/fit/brush_hand.h"

#include <algorithm>
#include <cmath>

namespace tuft::writer {
namespace {

constexpr double kBlunt = 12;       // units of half width from which an end is blunt
constexpr double kLiftTime = 0.03;  // seconds from the last ink to the free tip

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

}  // namespace

stroke::StrokeSamples samples_of(std::span<const Station> stations, const BrushHand& hand, const Pace& pace) {
    stroke::StrokeSamples trace;
    std::vector<double> along{0};
    for (std::size_t i = 1; i < stations.size(); ++i)
        along.push_back(along.back() + glm::distance(stations[i].centre, stations[i - 1].centre));
    const std::size_t near_end = stations.size() - std::min<std::size_t>(stations.size(), 4);
    const bool blunt = stations[near_end].half > kBlunt;
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
                                 .pressure = pressure_of(stations[i].half, hand)});
    }
    stroke::StrokeSample last = trace.samples.back();
    last.time += kLiftTime;
    last.pressure = 0;
    trace.samples.push_back(last);
    return trace;
}

}  // namespace tuft::writer
