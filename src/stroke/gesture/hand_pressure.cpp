#include "stroke/gesture/hand_pressure.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/first_order_lag.h"

namespace tuft::stroke {
namespace {

constexpr double kTaper = 3e-3;       // metres over which the hand lifts
constexpr double kTaperShare = 0.25;  // of the path, at most
constexpr double kTaperEnd = 0.08;    // of the pressure, where the path ends
constexpr double kBackShare = 0.6;    // of the taper that the lifting hand goes back
constexpr double kLift = 0.06;        // seconds of it
constexpr int kLiftSamples = 8;
constexpr double kLook = 0.03;  // seconds of the trace that give its first speed

double first_speed(const std::vector<StrokeSample>& samples) {
    double travel = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        travel += glm::length(samples[i].position - samples[i - 1].position);
        const double dt = samples[i].time - samples[0].time;
        if (dt > 0 && (dt >= kLook || i + 1 == samples.size())) return travel / dt;
    }
    return 0;
}

// The tip is taken back over the end of the stroke while it lifts, so that the hair springs
// onto ink and draws no drop beyond the end. `left`: metres from each sample to the end.
void lift_back(std::vector<StrokeSample>& samples, const std::vector<double>& left, double travel) {
    const StrokeSample end = samples.back();
    std::size_t i = samples.size() - 1;
    for (int k = 1; k <= kLiftSamples; ++k) {
        const double part = static_cast<double>(k) / kLiftSamples;
        while (i > 0 && (i + 1 == left.size() || left[i] < part * travel)) --i;
        const double span = left[i] - left[i + 1];
        const double w = span > 0 ? (part * travel - left[i + 1]) / span : 0;
        StrokeSample s = end;
        s.position = samples[i + 1].position + w * (samples[i].position - samples[i + 1].position);
        s.time = end.time + part * kLift;
        s.pressure = end.pressure * (1 - part);
        samples.push_back(s);
    }
}

}  // namespace

void track_motion(PressureState& s, double travel, double dt, const PressureOptions& o) {
    s.speed += settled_part(dt, o.speed_time) * (travel / dt - s.speed);
    const double slow = s.speed / o.still;
    s.rest += settled_part(dt, o.dwell_time) * (1 / (1 + slow * slow) - s.rest);
}

double pressure_goal(const PressureState& s, const PressureOptions& o) {
    double goal = o.level;
    if (o.from != PressureFrom::dwell)
        goal *= 1 - o.speed_effect * (o.linear ? std::min(1.0, s.speed / o.fast) : -std::expm1(-s.speed / o.fast));
    if (o.from != PressureFrom::speed) goal *= 1 + o.dwell_effect * s.rest;
    return std::clamp(goal, o.least, 1.0);
}

double press(PressureState& s, const Vec3& position, double time, const PressureOptions& o) {
    if (!s.started) {
        s.started = true;
        s.time = time;
        s.position = position;
        return s.pressure;
    }
    const double dt = time - s.time;
    if (!(dt > 0)) return s.pressure;  // the path is counted with the next sample
    track_motion(s, glm::length(position - s.position), dt, o);
    s.pressure += settled_part(dt, o.follow) * (pressure_goal(s, o) - s.pressure);
    s.time = time;
    s.position = position;
    return s.pressure;
}

StrokeSamples press(StrokeSamples trace, const PressureOptions& o) {
    auto& samples = trace.samples;
    if (o.from == PressureFrom::none || samples.empty()) return trace;
    PressureState state;
    state.speed = first_speed(samples);
    std::vector<double> left(samples.size(), 0);  // metres to the end
    for (std::size_t i = samples.size() - 1; i > 0; --i)
        left[i - 1] = left[i] + glm::length(samples[i].position - samples[i - 1].position);
    const double taper = std::min(kTaper, kTaperShare * left[0]);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double p = press(state, samples[i].position, samples[i].time, o);
        const double x = taper > 0 ? std::clamp(left[i] / taper, 0.0, 1.0) : 1.0;
        samples[i].pressure = p * (kTaperEnd + (1 - kTaperEnd) * x * (2 - x));
    }
    if (taper > 0) lift_back(samples, left, kBackShare * taper);
    samples.back().pressure = 0;
    return trace;
}

}  // namespace tuft::stroke
