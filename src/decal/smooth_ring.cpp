#include "decal/smooth_ring.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::decal {
namespace {

constexpr double kBand = 0.5;  // texels
constexpr double kStep = 0.1;  // λ; stable below 1/8
constexpr double kMostSteps = 300;
constexpr double kLeastPoints = 16;
constexpr double kLostSize = 0.02;  // of a ring's size that all steps may take, before its area is restored
constexpr int kPerPoint = 4;

double length_of(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) sum += glm::length(ring[(i + 1) % ring.size()] - ring[i]);
    return sum;
}

/// `n` points at even distances along a ring.
Ring resample(const Ring& ring, std::size_t n) {
    const double step = length_of(ring) / static_cast<double>(n);
    Ring out;
    out.reserve(n);
    double at = 0;
    for (std::size_t i = 0; i < ring.size() && out.size() < n; ++i) {
        const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const double length = glm::length(b - a);
        for (; out.size() < n;) {
            const double s = static_cast<double>(out.size()) * step - at;
            if (s > length) break;
            out.push_back(length > 0 ? a + s / length * (b - a) : a);
        }
        at += length;
    }
    while (out.size() < n) out.push_back(ring.back());
    return out;
}

void bend_less(Ring& ring, double band) {
    const std::size_t n = ring.size();
    const double bend = std::pow(2 * std::numbers::pi / static_cast<double>(n), 4);
    const int steps = static_cast<int>(std::min(kMostSteps, kLostSize / (kStep * bend)));
    const Ring start = ring;
    Ring next(n);
    for (int k = 0; k < steps; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 &a = ring[(i + n - 2) % n], &b = ring[(i + n - 1) % n], &c = ring[(i + 1) % n],
                       &d = ring[(i + 2) % n];
            const Vec2 moved = ring[i] - kStep * (a - 4.0 * b + 6.0 * ring[i] - 4.0 * c + d) - start[i];
            const double far = glm::length(moved);
            next[i] = start[i] + (far > band ? band / far * moved : moved);
        }
        ring.swap(next);
    }
}

Ring catmull_rom(const Ring& ring) {
    const std::size_t n = ring.size();
    Ring out;
    out.reserve(n * kPerPoint);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 &a = ring[(i + n - 1) % n], &b = ring[i], &c = ring[(i + 1) % n], &d = ring[(i + 2) % n];
        for (int k = 0; k < kPerPoint; ++k) {
            const double t = static_cast<double>(k) / kPerPoint;
            out.push_back(b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a))));
        }
    }
    return out;
}

/// Moves a ring outwards by what its area lacks, spread over its length.
void restore_area(Ring& ring, double area) {
    const double length = length_of(ring);
    if (!(length > 0)) return;
    const double out = (area - area_of(ring)) / length;
    const std::size_t n = ring.size();
    Ring moved = ring;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 along = ring[(i + 1) % n] - ring[(i + n - 1) % n];
        const double far = glm::length(along);
        if (far > 0) moved[i] += out / far * Vec2(along.y, -along.x);
    }
    ring = std::move(moved);
}

}  // namespace

Ring smooth_ring(const Ring& ring, double texel) {
    const double points = std::max(kLeastPoints, std::ceil(length_of(ring) / texel));
    Ring out = resample(ring, static_cast<std::size_t>(points));
    bend_less(out, kBand * texel);
    out = catmull_rom(out);
    restore_area(out, area_of(ring));
    return out;
}

}  // namespace tuft::decal
