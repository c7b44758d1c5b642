#include "hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "brush/calibration/sweep.h"
#include "brush/preset/preset.h"
#include "stroke/placement/placement.h"

namespace tuft::samples {

namespace {

/// A point of the motion before it has a time, metres.
struct Spot {
    Vec2 p{0};
    double width = 0, pace = 1;
    double length = 0;  ///< along the path, changes of width count too
};

/// Distance that the hand feels between two keys: pressing is a motion too.
double travel(const Spot& a, const Spot& b) {
    return std::hypot(glm::length(b.p - a.p), 0.7 * (b.width - a.width));
}

/// Slopes of the monotone cubic through (t, v).
std::vector<double> monotone_slopes(const std::vector<double>& t, const std::vector<double>& v) {
    const std::size_t n = t.size();
    std::vector<double> slope(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double h0 = t[i] - t[i - 1], h1 = t[i + 1] - t[i];
        const double d0 = (v[i] - v[i - 1]) / h0, d1 = (v[i + 1] - v[i]) / h1;
        if (d0 * d1 > 0) slope[i] = 3 * (h0 + h1) / ((2 * h1 + h0) / d0 + (h1 + 2 * h0) / d1);
    }
    return slope;
}

double hermite(double v0, double m0, double v1, double m1, double h, double u) {
    const double u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * v0 + (u3 - 2 * u2 + u) * h * m0 + (3 * u2 - 2 * u3) * v1 + (u3 - u2) * h * m1;
}

/// Dense points along one smooth piece.
std::vector<Spot> trace_piece(const std::vector<Spot>& keys) {
    std::vector<double> t{0}, width, pace;
    for (std::size_t i = 1; i < keys.size(); ++i)
        t.push_back(t.back() + std::max(1e-6, std::sqrt(travel(keys[i - 1], keys[i]))));
    for (const Spot& k : keys) {
        width.push_back(k.width);
        pace.push_back(k.pace);
    }
    const auto width_slope = monotone_slopes(t, width), pace_slope = monotone_slopes(t, pace);
    const auto tangent = [&](std::size_t i) -> Vec2 {
        if (keys.size() < 3) return (keys.back().p - keys.front().p) / (t.back() - t.front());
        if (i == 0 || i + 1 == keys.size()) {  // the end of a parabola
            const std::size_t a = i == 0 ? 0 : i, b = i == 0 ? 1 : i - 1, c = i == 0 ? 2 : i - 2;
            const Vec2 ab = (keys[b].p - keys[a].p) / (t[b] - t[a]);
            const Vec2 bc = (keys[c].p - keys[b].p) / (t[c] - t[b]);
            return ab + (ab - bc) * ((t[b] - t[a]) / (t[c] - t[a]));
        }
        const Vec2 before = (keys[i].p - keys[i - 1].p) / (t[i] - t[i - 1]);
        const Vec2 after = (keys[i + 1].p - keys[i].p) / (t[i + 1] - t[i]);
        return (before * (t[i + 1] - t[i]) + after * (t[i] - t[i - 1])) / (t[i + 1] - t[i - 1]);
    };
    std::vector<Spot> spots{keys.front()};
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const double h = t[i + 1] - t[i];
        const Vec2 m0 = tangent(i), m1 = tangent(i + 1);
        const int steps = std::max(4, static_cast<int>(travel(keys[i], keys[i + 1]) / 2e-5));
        for (int k = 1; k <= steps; ++k) {
            const double u = double(k) / steps;
            Spot s;
            for (int c = 0; c < 2; ++c) s.p[c] = hermite(keys[i].p[c], m0[c], keys[i + 1].p[c], m1[c], h, u);
            s.width = hermite(width[i], width_slope[i], width[i + 1], width_slope[i + 1], h, u);
            s.pace = hermite(pace[i], pace_slope[i], pace[i + 1], pace_slope[i + 1], h, u);
            s.length = spots.back().length + travel(spots.back(), s);
            spots.push_back(s);
        }
    }
    return spots;
}

/// Seconds at each spot: speed is bounded by pace, by the bend and by the acceleration
/// from one spot to the next, both ways.
std::vector<double> time_piece(const std::vector<Spot>& spots, const WriteOptions& o) {
    const std::size_t n = spots.size();
    std::vector<double> speed(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t a = i > 8 ? i - 8 : 0, b = std::min(i + 8, n - 1);
        const Vec2 d0 = spots[i].p - spots[a].p, d1 = spots[b].p - spots[i].p;
        const double l0 = glm::length(d0), l1 = glm::length(d1);
        double bend = 0;
        if (l0 > 1e-7 && l1 > 1e-7)  // else it presses in place
            bend = std::acos(std::clamp(glm::dot(d0, d1) / (l0 * l1), -1.0, 1.0)) /
                   (0.5 * (spots[b].length - spots[a].length));
        speed[i] = o.speed * std::max(0.05, spots[i].pace) / (1 + o.turn_radius * bend);
    }
    const double creep = 0.1 * o.speed;
    speed.front() = speed.back() = creep;
    for (std::size_t i = 1; i < n; ++i) {
        const double ds = spots[i].length - spots[i - 1].length;
        speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * o.acceleration * ds));
    }
    for (std::size_t i = n - 1; i-- > 0;) {
        const double ds = spots[i + 1].length - spots[i].length;
        speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + 2 * o.acceleration * ds));
    }
    std::vector<double> time(n, 0.0);
    for (std::size_t i = 1; i < n; ++i)
        time[i] = time[i - 1] + 2 * (spots[i].length - spots[i - 1].length) / (speed[i] + speed[i - 1]);
    return time;
}

}  // namespace

WidthTable::WidthTable(const brush::Preset& preset) {
    const double deepest = stroke::working_depth(preset);
    std::vector<double> depths;
    for (int i = 1; i <= 40; ++i) depths.push_back(deepest * i / 40);
    widths_ = {0};
    pressures_ = {0};
    for (const brush::SweepRow& row : brush::sweep_depth(preset, depths)) {
        if (row.width <= widths_.back() + 1e-6) {  // the bare tip: press as far as the line stays fine
            pressures_.back() = std::max(pressures_.back(), widths_.size() > 1 ? row.depth / deepest : 0.0);
            continue;
        }
        widths_.push_back(row.width);
        pressures_.push_back(row.depth / deepest);
    }
}

double WidthTable::pressure(double width) const {
    if (width <= 0) return 0;
    const auto it = std::lower_bound(widths_.begin(), widths_.end(), width);
    if (it == widths_.end()) return pressures_.back();
    const std::size_t i = static_cast<std::size_t>(it - widths_.begin());
    const double u = (width - widths_[i - 1]) / (widths_[i] - widths_[i - 1]);
    return pressures_[i - 1] + u * (pressures_[i] - pressures_[i - 1]);
}

stroke::RecordedStroke write(const Stroke& stroke, const WidthTable& table, const WriteOptions& o) {
    std::vector<Spot> spots;
    std::vector<double> times;
    std::vector<Spot> keys;
    for (std::size_t i = 0; i < stroke.keys.size(); ++i) {
        const Key& k = stroke.keys[i];
        keys.push_back({0.001 * o.size * (Vec2(k.x, k.y) - o.centre), 0.001 * o.size * k.width, k.pace, 0});
        const bool last = i + 1 == stroke.keys.size();
        if (keys.size() > 1 && (k.rest >= 0 || last)) {
            const auto piece = trace_piece(keys);
            const auto time = time_piece(piece, o);
            const double start = times.empty() ? 0 : times.back();
            for (std::size_t j = times.empty() ? 0 : 1; j < piece.size(); ++j) {
                spots.push_back(piece[j]);
                times.push_back(start + time[j]);
            }
            keys = {keys.back()};
        }
        if (k.rest > 0 && !times.empty()) {
            spots.push_back(spots.back());
            times.push_back(times.back() + k.rest);
        }
    }
    stroke::RecordedStroke trace;
    trace.label = stroke.name;
    std::size_t i = 0;
    const std::size_t n = static_cast<std::size_t>(std::ceil(times.back() * o.sample_rate));
    for (std::size_t k = 0; k <= n; ++k) {
        const double t = std::min(static_cast<double>(k) / o.sample_rate, times.back());
        while (i + 2 < times.size() && times[i + 1] < t) ++i;
        const double h = times[i + 1] - times[i];
        const double u = h > 0 ? std::clamp((t - times[i]) / h, 0.0, 1.0) : 1.0;
        const Vec2 p = spots[i].p + u * (spots[i + 1].p - spots[i].p);
        const double width = spots[i].width + u * (spots[i + 1].width - spots[i].width);
        trace.samples.push_back({.time = t, .position = Vec3(p, 0), .pressure = table.pressure(width), .tilt = o.tilt});
    }
    return trace;
}

void Series::add(const Stroke& stroke, const char* brush, const char* ink, double speed,
                 std::vector<stroke::Preparation> before, const Vec2& tilt) {
    WriteOptions options;
    options.size = 1;  // keys are in millimetres
    options.centre = {0, 0};
    options.speed = speed;
    options.tilt = tilt;
    stroke::RecordedStroke t = write(stroke, WidthTable(brush::load_preset(brush)), options);
    t.placement = place;
    t.brush = brush;
    t.ink = ink;
    t.seed = out.size() + 1;
    t.label = stroke.name;
    t.before = std::move(before);
    out.push_back(std::move(t));
}

}  // namespace tuft::samples
