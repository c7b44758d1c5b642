#include "curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tuft::models {

namespace {

/// Slopes of the cubic spline through keys first..last (Thomas algorithm), with
/// second derivative 0 at the ends, or slope 0 where `flat_first`, `flat_last`.
std::vector<double> spline_slopes(const std::vector<Curve::Key>& k, std::size_t first, std::size_t last,
                                  bool flat_first, bool flat_last) {
    const std::size_t n = last - first + 1;
    std::vector<double> upper(n, 0), right(n, 0), slope(n, 0);
    const auto step = [&](std::size_t i) { return k[first + i + 1].at - k[first + i].at; };
    const auto rise = [&](std::size_t i) { return (k[first + i + 1].value - k[first + i].value) / step(i); };
    double pivot = 1;
    if (!flat_first) {
        pivot = 2;
        upper[0] = 1 / pivot;
        right[0] = 3 * rise(0) / pivot;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double a = 1 / step(i - 1), c = 1 / step(i);
        pivot = 2 * (a + c) - a * upper[i - 1];
        upper[i] = c / pivot;
        right[i] = (3 * (a * rise(i - 1) + c * rise(i)) - a * right[i - 1]) / pivot;
    }
    slope[n - 1] = flat_last ? 0 : (3 * rise(n - 2) - right[n - 2]) / (2 - upper[n - 2]);
    for (std::size_t i = n - 1; i-- > 0;) slope[i] = right[i] - upper[i] * slope[i + 1];
    return slope;
}

}  // namespace

Curve::Curve(std::vector<Key> keys, bool flat_ends) : keys_(std::move(keys)) {
    const std::size_t n = keys_.size();
    assert(n >= 2);
    slope_in_.assign(n, 0);
    slope_out_.assign(n, 0);
    for (std::size_t first = 0; first + 1 < n;) {
        std::size_t last = first + 1;
        while (last + 1 < n && !keys_[last].corner) ++last;
        const std::vector<double> slope =
            spline_slopes(keys_, first, last, flat_ends && first == 0, flat_ends && last + 1 == n);
        for (std::size_t i = first; i <= last; ++i) {
            if (i > first) slope_in_[i] = slope[i - first];
            if (i < last) slope_out_[i] = slope[i - first];
        }
        first = last;
    }
    slope_in_[0] = slope_out_[0];
    slope_out_[n - 1] = slope_in_[n - 1];
}

double Curve::operator()(double at) const {
    const std::size_t n = keys_.size();
    if (at <= keys_[0].at) return keys_[0].value + slope_in_[0] * (at - keys_[0].at);
    if (at >= keys_[n - 1].at) return keys_[n - 1].value + slope_out_[n - 1] * (at - keys_[n - 1].at);
    std::size_t k = 0;
    while (at > keys_[k + 1].at) ++k;
    const double h = keys_[k + 1].at - keys_[k].at, t = (at - keys_[k].at) / h, u = 1 - t;
    return (1 + 2 * t) * u * u * keys_[k].value + t * u * u * h * slope_out_[k] +
           t * t * (3 - 2 * t) * keys_[k + 1].value - t * t * u * h * slope_in_[k + 1];
}

PlaneLine::PlaneLine(std::vector<Vec2> points) : points_(std::move(points)), length_{0} {
    for (std::size_t i = 1; i < points_.size(); ++i)
        length_.push_back(length_.back() + glm::length(points_[i] - points_[i - 1]));
}

Vec2 PlaneLine::point(double u) const {
    const auto it = std::upper_bound(length_.begin() + 1, length_.end() - 1, u);
    const auto k = static_cast<std::size_t>(it - length_.begin()) - 1;
    const double t = (u - length_[k]) / (length_[k + 1] - length_[k]);
    return glm::mix(points_[k], points_[k + 1], t);
}

Vec2 PlaneLine::left_normal(double u) const {
    const double h = 1e-3 * length();
    const Vec2 t = point(std::min(u + h, length())) - point(std::max(u - h, 0.0));
    return glm::normalize(Vec2{-t.y, t.x});
}

double PlaneLine::find(int axis, double value, bool from_end) const {
    const std::size_t n = points_.size();
    for (std::size_t step = 0; step + 1 < n; ++step) {
        const std::size_t k = from_end ? n - 2 - step : step;
        const double a = points_[k][axis], b = points_[k + 1][axis];
        if ((a - value) * (b - value) <= 0 && a != b)
            return length_[k] + (length_[k + 1] - length_[k]) * (value - a) / (b - a);
    }
    assert(false && "value not on the line");
    return 0;
}

double smooth_step(double from, double to, double at) {
    const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace tuft::models
