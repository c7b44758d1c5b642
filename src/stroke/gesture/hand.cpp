#include "stroke/gesture/hand.h"

#include <algorithm>

#include "stroke/gesture/roll.h"

namespace tuft::stroke {
namespace {

constexpr double kCatchUpSpacing = 2.5e-4;  // metres between samples while the tip catches up
constexpr double kSlowestCatchUp = 0.02;    // m/s

double mean_speed(const std::vector<StrokeSample>& samples) {
    double length = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        length += glm::length(samples[i].position - samples[i - 1].position);
    const double time = samples.back().time - samples.front().time;
    return time > 0 ? std::max(length / time, kSlowestCatchUp) : kSlowestCatchUp;
}

}  // namespace

StrokeSamples steady(StrokeSamples trace, const StrokeSettings& settings) {
    auto& samples = trace.samples;
    if (samples.empty() || !trace.flat) return trace;
    if (settings.smooth > 0) {
        const HandFilterOptions options = hand_filter_options(settings.smooth);
        const double end = samples.back().time;
        for (int pass = 0; pass < 2; ++pass) {
            HandFilter filter;
            for (StrokeSample& s : samples) {
                StrokeSample now = s;
                if (pass == 1) now.time = end - s.time;
                now = smooth(filter, now, options);
                now.time = s.time;
                s = now;
            }
            std::reverse(samples.begin(), samples.end());
        }
    }
    if (settings.stabilise > 0) {
        const double speed = mean_speed(samples);
        String string;
        for (StrokeSample& s : samples) s = pull(string, s, settings.stabilise);
        let_go(string, samples.back().time, speed, kCatchUpSpacing, samples);
    }
    return press(roll_holder(std::move(trace), settings), {.from = settings.pressure});
}

brush::Pose steady(GestureFilter& state, const brush::Pose& pose, const StrokeSettings& settings) {
    brush::Pose out = pose;
    if (settings.smooth > 0) out = smooth(state.filter, out, hand_filter_options(settings.smooth));
    if (settings.stabilise > 0) out = pull(state.string, out, settings.stabilise);
    return out;
}

}  // namespace tuft::stroke
