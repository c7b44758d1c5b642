#include "stroke/placement/smoothed_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/ease.h"
#include "core/simd.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::stroke {

namespace {

using mesh::SurfaceQuery;

constexpr int kRings = 3;        // of the hexagonal pattern of samples
constexpr double kFit = 0.7;     // part of the pattern that must lie on the surface for its curvature
constexpr double kLeast = 0.35;  // and for its slope
// `level_at`: mismatch in parts of its radius, and of a disk half as wide in parts of the wider one's
constexpr double kTrusted = 0.005, kDoubted = 0.02, kSame = 0.75, kBetter = 0.25;
constexpr double kBelow = 0.3;  // there; a hand rests on what is high

const std::vector<Vec2>& pattern() {
    static const std::vector<Vec2> points = [] {
        std::vector<Vec2> p;
        for (int j = -kRings; j <= kRings; ++j)
            for (int i = std::max(-kRings, -kRings - j); i <= std::min(kRings, kRings - j); ++i)
                p.push_back(Vec2(i + 0.5 * j, 0.5 * std::sqrt(3.0) * j) / double(kRings));
        return p;
    }();
    return points;
}

/// Solves A x = b for symmetric positive A in place; false when A has no such inverse.
template <int N>
bool solve(std::array<std::array<double, N>, N>& a, std::array<double, N>& b) {
    for (int k = 0; k < N; ++k) {
        if (!(a[k][k] > 1e-12)) return false;
        for (int i = k + 1; i < N; ++i) {
            const double f = a[i][k] / a[k][k];
            for (int j = k; j < N; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int k = N - 1; k >= 0; --k) {
        for (int j = k + 1; j < N; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return true;
}

/// Places over a disk, in radii, and the terms of the paraboloid there.
struct Heights {
    static constexpr int kTerms = 6, kPadded = 8, kMost = 37;  // of kRings rings
    double a[kMost], b[kMost], z[kMost];
    double terms[kMost][kPadded];  // 1, a, b, a²/2, ab, b²/2
    double weight[kMost];          // of a fit
    double rest[kMost];            // height over it
    int size = 0;

    void add(double at_a, double at_b, double height) {
        a[size] = at_a, b[size] = at_b, z[size] = height;
        const double all[kPadded] = {1, at_a, at_b, 0.5 * at_a * at_a, at_a * at_b, 0.5 * at_b * at_b};
        std::copy(std::begin(all), std::end(all), terms[size++]);
    }
};

constexpr double kNarrow = 0.01;  // radii: differences of height that count fully

TUFT_CLONES void weigh(Heights& heights, const double* c, int terms, double below, bool first) {
    for (int i = 0; i < heights.size; ++i) {
        double rest = heights.z[i];
        for (int k = 0; k < terms; ++k) rest -= c[k] * heights.terms[i][k];
        heights.rest[i] = rest;
        const double side = rest < 0 ? below : 1;
        heights.weight[i] = first ? 1 : side / __builtin_sqrt(1 + rest * rest / (kNarrow * kNarrow));
    }
}

/// Sums of the weighted products of the terms, and with the heights. Rows of both are padded.
template <int N>
[[gnu::always_inline]] inline void sum_in_registers(const Heights& heights, double (*lhs)[Heights::kPadded],
                                                    double* rhs) {
    double left[N][Heights::kPadded] = {}, right[N] = {};
    for (int i = 0; i < heights.size; ++i) {
        const double* all = heights.terms[i];
        for (int k = 0; k < N; ++k) {
            const double scaled = heights.weight[i] * all[k];
            right[k] += scaled * heights.z[i];
            for (int j = 0; j < Heights::kPadded; ++j) left[k][j] += scaled * all[j];
        }
    }
    std::copy_n(&left[0][0], N * Heights::kPadded, &lhs[0][0]);
    std::copy_n(right, N, rhs);
}

TUFT_CLONES void sum_products(const Heights& heights, int terms, double (*lhs)[Heights::kPadded], double* rhs) {
    if (terms == Heights::kTerms)
        sum_in_registers<Heights::kTerms>(heights, lhs, rhs);
    else
        sum_in_registers<3>(heights, lhs, rhs);
}

/// Least sum of pseudo-Huber distances, which narrow grooves hardly bend; convex, so that the
/// fit changes as little as the surface does. N = 6: with curvature; 3: without.
template <int N>
bool fit(Heights& heights, double below, std::array<double, N>& c) {
    constexpr int kPasses = 8;
    c.fill(0);
    for (int pass = 0; pass < kPasses; ++pass) {
        double sums[N][Heights::kPadded];
        std::array<std::array<double, N>, N> lhs{};
        std::array<double, N> rhs{};
        weigh(heights, c.data(), N, below, pass == 0);
        sum_products(heights, N, sums, rhs.data());
        for (int k = 0; k < N; ++k) std::copy_n(sums[k], N, lhs[k].begin());
        if (!solve<N>(lhs, rhs)) return false;
        c = rhs;
    }
    return true;
}

/// Median distance of the samples from the fit, in radii.
template <int N>
double fit_error_of(Heights& heights, const std::array<double, N>& c) {
    weigh(heights, c.data(), N, 1, false);
    double* rests = heights.rest;
    for (int i = 0; i < heights.size; ++i) rests[i] = std::abs(rests[i]);
    double* middle = rests + heights.size / 2;
    std::nth_element(rests, middle, rests + heights.size);
    return *middle;
}

Vec3 any_across(const Vec3& normal) {
    return into_plane(std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), normal);
}

/// The triangle's unit normal as its corners go round.
}  // namespace

double clearance(const SurfaceQuery& query, const Vec3& p, const Vec3& normal, double most) {
    double from = 0;
    for (int hop = 0; hop < 4; ++hop) {  // a point within a bump first meets the bump's outside
        const mesh::RayHit hit =
            query.trace(Vec3f(p + from * normal), Vec3f(normal), float(1e-3 * most), float(most - from));
        if (hit.triangle == kNone) return most;
        const double at = from + hit.distance;
        if (glm::dot(face_normal(query.mesh(), hit.triangle), normal) < 0) return 0.5 * at;
        from = at;
        if (from >= most) break;
    }
    return most;
}

SurfacePatch fit_patch(const SurfaceQuery& query, const SurfacePatch& guess, double radius, double below) {
    const Vec3 side = glm::cross(guess.normal, guess.heading);
    const double up = clearance(query, guess.position, guess.normal, radius);
    const Vec3f down(-guess.normal);
    Heights heights;
    for (const Vec2& p : pattern()) {
        const double bulge =
            0.5 * radius *
            (guess.curvature[0] * p.x * p.x + 2 * guess.curvature[1] * p.x * p.y + guess.curvature[2] * p.y * p.y);
        const Vec3 eye = guess.position + radius * (p.x * guess.heading + p.y * side) +
                         (up + std::clamp(radius * bulge, -radius, radius)) * guess.normal;
        const mesh::RayHit hit = query.trace(Vec3f(eye), down, 0, float(up + radius));
        if (hit.triangle == kNone || glm::dot(face_normal(query.mesh(), hit.triangle), guess.normal) < 0.1) continue;
        heights.add(p.x, p.y, (glm::dot(eye - guess.position, guess.normal) - double(hit.distance)) / radius);
    }
    SurfacePatch patch = guess;
    const auto part = double(heights.size) / double(pattern().size());
    double height = 0, fit_error = 0;
    Vec2 slope{0};
    if (std::array<double, 6> c; part >= kFit && fit<6>(heights, below, c)) {
        fit_error = fit_error_of<6>(heights, c);
        height = c[0];
        slope = {c[1], c[2]};
        const double most = 1.0;  // detail sharper than the disk is no different from noise
        for (int k = 0; k < 3; ++k) patch.curvature[k] = std::clamp(c[3 + k], -most, most) / radius;
    } else if (std::array<double, 3> d; part >= kLeast) {
        for (int i = 0; i < heights.size; ++i) {
            const double at_a = heights.a[i], at_b = heights.b[i];
            heights.z[i] -= 0.5 * radius *
                            (guess.curvature[0] * at_a * at_a + 2 * guess.curvature[1] * at_a * at_b +
                             guess.curvature[2] * at_b * at_b);
        }
        if (!fit<3>(heights, below, d)) return patch;
        fit_error = fit_error_of<3>(heights, d);
        height = d[0];
        slope = {d[1], d[2]};
    } else {
        return patch;
    }
    patch.found = true;
    patch.fit_error = radius * fit_error;
    patch.position += radius * height * guess.normal;
    patch.normal = glm::normalize(guess.normal - slope.x * guess.heading - slope.y * side);
    patch.heading = into_plane(parallel_transport(guess.heading, guess.normal, patch.normal), patch.normal);
    return patch;
}

double level_at(const SurfaceQuery& query, const Vec3& position, const Vec3& normal, double radius) {
    constexpr int kScales = 3;
    double height = 0, left = 1, before = 0;
    for (int scale = 0; scale < kScales; ++scale) {
        const SurfacePatch patch =
            fit_patch(query, {.position = position, .normal = normal, .heading = any_across(normal)},
                      radius / double(1 << scale), kBelow);
        if (!patch.found) continue;
        const double up = glm::dot(patch.position - position, normal);
        if (before > 0) left *= smooth_step((kSame - patch.fit_error / before) / (kSame - kBetter));
        height += left * (up - height);
        left *= smooth_step((patch.fit_error / radius - kTrusted) / (kDoubted - kTrusted));
        before = patch.fit_error;
        if (left <= 0) break;
    }
    return height;
}

}  // namespace tuft::stroke
