#include "stroke/drawing/bend.h"

#include <algorithm>
#include <cmath>

namespace tuft::stroke {
namespace {

constexpr double kFlat = 1e-9;  // of the curvature times the width: no bend

/// Parts that a chord is split into: sagitta κ l² / 8 below 0.1 % of the width, for parts of length l.
int parts_of(const Vec2& a, const Vec2& b, double curvature, double width) {
    const double longest = std::sqrt(8e-3 * width / std::max(std::abs(curvature), 1e-12));
    return static_cast<int>(std::clamp(std::ceil(glm::distance(a, b) / longest), 1.0, 1000.0));
}

void bend_path(std::vector<Vec2>& path, bool closed, double curvature, double width) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const bool last = !closed && i + 1 == path.size();
        const Vec2 &a = path[i], &b = last ? a : path[(i + 1) % path.size()];
        const int n = parts_of(a, b, curvature, width);
        for (int k = 0; k < n; ++k) out.push_back(bend_point(glm::mix(a, b, static_cast<double>(k) / n), curvature));
    }
    path = std::move(out);
}

void bend_ring(std::vector<Vec2>& ring, double curvature, double width) {
    bend_path(ring, true, curvature, width);
}

bool is_flat(double curvature, double width) {
    return !(std::abs(curvature) * width > kFlat);
}

}  // namespace

void lap_ends(std::vector<std::vector<Vec2>>& rings, double half, double lap) {
    constexpr double kAtEnd = 1e-6;  // of the half width: rounding of drawings
    for (auto& ring : rings)
        for (Vec2& p : ring)
            if (std::abs(std::abs(p.x) - half) < kAtEnd * half) p.x += p.x > 0 ? lap : -lap;
}

Vec2 bend_point(const Vec2& p, double curvature) {
    const double angle = p.x * curvature;
    // sin(a)/κ and (cos(a) − 1)/κ without a loss of digits where κ is small.
    const double half = 0.5 * angle, sinc = half != 0 ? std::sin(half) / half : 1;
    return {p.x * sinc * std::cos(half) + p.y * std::sin(angle), p.y * std::cos(angle) - p.x * sinc * std::sin(half)};
}

void bend_samples(StrokeSamples& trace, double curvature, double width) {
    if (is_flat(curvature, width)) return;
    for (StrokeSample& s : trace.samples) {
        const double angle = s.position.x * curvature, c = std::cos(angle), d = std::sin(angle);
        s.position = Vec3(bend_point(Vec2(s.position), curvature), s.position.z);
        s.tilt = {c * s.tilt.x + d * s.tilt.y, c * s.tilt.y - d * s.tilt.x};
        s.roll += angle;
    }
    std::vector<StencilEdge> stencil;
    for (const StencilEdge& e : trace.stencil) {
        const int n = parts_of(e.from, e.to, curvature, width);
        for (int k = 0; k < n; ++k)
            stencil.push_back({bend_point(glm::mix(e.from, e.to, static_cast<double>(k) / n), curvature),
                               bend_point(glm::mix(e.from, e.to, static_cast<double>(k + 1) / n), curvature)});
    }
    trace.stencil = std::move(stencil);
    for (auto& ring : trace.outline) bend_ring(ring, curvature, width);
}

void bend_area(FlatArea& area, double curvature, double width) {
    if (is_flat(curvature, width)) return;
    for (auto* rings : {&area.rings, &area.under})
        for (auto& ring : *rings) bend_ring(ring, curvature, width);
    for (auto& line : area.lines) bend_path(line, false, curvature, width);
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const auto& ring : area.rings)
        for (const Vec2& p : ring) low = glm::min(low, p), high = glm::max(high, p);
    area.low = low, area.high = high;
}

}  // namespace tuft::stroke
