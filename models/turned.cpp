#include "turned.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace tuft::models {

namespace {

/// Tangents of the clamped C2 cubic spline over knots `s` (tridiagonal system, Thomas algorithm).
std::vector<Vec2> spline_tangents(std::span<const Vec2> p, std::span<const double> s, Vec2 first, Vec2 last) {
    const std::size_t n = p.size();
    std::vector<Vec2> tangent(n), right(n);
    std::vector<double> upper(n, 0);
    right[0] = first;
    for (std::size_t i = 1; i < n; ++i) {
        if (i + 1 == n) {
            tangent[i] = last;
            break;
        }
        const double h0 = s[i] - s[i - 1];
        const double h1 = s[i + 1] - s[i];
        const Vec2 b = 3.0 * (h1 / h0 * (p[i] - p[i - 1]) + h0 / h1 * (p[i + 1] - p[i]));
        const double pivot = 2 * (h0 + h1) - h1 * upper[i - 1];
        upper[i] = h0 / pivot;
        right[i] = (b - h1 * right[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 0;) tangent[i] = right[i] - upper[i] * tangent[i + 1];
    return tangent;
}

Shape turn_outline(std::span<const Vec2> outline, int n_around, bool ring) {
    Shape shape;
    const auto n = static_cast<std::uint32_t>(n_around);
    std::vector<std::uint32_t> row_start;
    std::vector<bool> on_axis;
    for (const Vec2& p : outline) {
        row_start.push_back(static_cast<std::uint32_t>(shape.points.size()));
        on_axis.push_back(!ring && std::abs(p.x) < 1e-9);
        if (on_axis.back()) {
            shape.points.emplace_back(0, 0, p.y);
            continue;
        }
        for (std::uint32_t k = 0; k < n; ++k) {
            const double a = 2 * std::numbers::pi * k / n;
            shape.points.emplace_back(p.x * std::cos(a), p.x * std::sin(a), p.y);
        }
    }
    const std::size_t rows = outline.size();
    for (std::size_t i = 0; i + (ring ? 0 : 1) < rows; ++i) {
        const std::size_t j = (i + 1) % rows;
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t l = (k + 1) % n;
            const std::uint32_t a = row_start[i], b = row_start[j];
            if (on_axis[i] && on_axis[j]) continue;
            if (on_axis[i]) {
                shape.triangles.push_back({a, b + l, b + k});
            } else if (on_axis[j]) {
                shape.triangles.push_back({a + k, a + l, b});
            } else {
                shape.triangles.push_back({a + k, a + l, b + l});
                shape.triangles.push_back({a + k, b + l, b + k});
            }
        }
    }
    return shape;
}

}  // namespace

void add_line(Outline& outline, Vec2 end, int n_steps) {
    const Vec2 start = outline.back();
    for (int i = 1; i <= n_steps; ++i) outline.push_back(start + (end - start) * (double(i) / n_steps));
}

void add_curve(Outline& outline, Vec2 a, Vec2 b, Vec2 end, int n_steps) {
    const Vec2 start = outline.back();
    for (int i = 1; i <= n_steps; ++i) {
        const double t = double(i) / n_steps, u = 1 - t;
        outline.push_back(u * u * u * start + 3 * u * u * t * a + 3 * u * t * t * b + t * t * t * end);
    }
}

void add_half_round(Outline& outline, Vec2 end, int n_steps) {
    const Vec2 start = outline.back();
    const Vec2 centre = 0.5 * (start + end);
    const Vec2 x = start - centre;
    const Vec2 y{-x.y, x.x};  // counter-clockwise: around the left side
    for (int i = 1; i <= n_steps; ++i) {
        const double a = std::numbers::pi * i / n_steps;
        outline.push_back(i == n_steps ? end : centre + std::cos(a) * x + std::sin(a) * y);
    }
}

void add_spline(Outline& outline, std::span<const Vec2> keys, Vec2 first_direction, Vec2 last_direction, int n_steps) {
    std::vector<Vec2> p{outline.back()};
    p.insert(p.end(), keys.begin(), keys.end());
    std::vector<double> s{0};
    for (std::size_t i = 1; i < p.size(); ++i) s.push_back(s.back() + glm::length(p[i] - p[i - 1]));
    const std::vector<Vec2> m = spline_tangents(p, s, glm::normalize(first_direction), glm::normalize(last_direction));
    std::size_t k = 0;
    for (int i = 1; i <= n_steps; ++i) {
        const double at = s.back() * i / n_steps;
        while (k + 2 < s.size() && at > s[k + 1]) ++k;
        const double h = s[k + 1] - s[k], t = (at - s[k]) / h, u = 1 - t;
        outline.push_back((1 + 2 * t) * u * u * p[k] + t * u * u * h * m[k] + t * t * (3 - 2 * t) * p[k + 1] -
                          t * t * u * h * m[k + 1]);
    }
}

Outline inner_side(std::span<const Vec2> outer, const std::function<double(double)>& thickness) {
    std::vector<double> s{0};
    for (std::size_t i = 1; i < outer.size(); ++i) s.push_back(s.back() + glm::length(outer[i] - outer[i - 1]));
    Outline inner;
    for (std::size_t i = outer.size(); i-- > 0;) {
        const Vec2 before = outer[i == 0 ? 0 : i - 1];
        const Vec2 after = outer[std::min(i + 1, outer.size() - 1)];
        const Vec2 along = glm::normalize(after - before);
        inner.push_back(outer[i] + thickness(s[i] / s.back()) * Vec2{-along.y, along.x});
    }
    return inner;
}

Shape turn(std::span<const Vec2> outline, int n_around) {
    return turn_outline(outline, n_around, false);
}

Shape turn_ring(std::span<const Vec2> outline, int n_around) {
    return turn_outline(outline, n_around, true);
}

}  // namespace tuft::models
