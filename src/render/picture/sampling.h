#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/geometry/types.h"
#include "core/random.h"

/// \file
/// Sample points for Monte Carlo sums: a (0,2)-sequence, shifted as a torus by a hash per pixel. Every pixel is
/// well stratified, and neighbours differ. Internal to `render/picture`.
namespace tuft::render {

/// Point i of Sobol's two-dimensional sequence, in [0,1)². Any first 2^k points are
/// stratified in all elementary intervals ([Sobol1967]; [Kollig2002]).
inline Vec2f sobol_point(std::uint32_t i) {
    std::uint32_t x = i;
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
    std::uint32_t y = 0;
    for (std::uint32_t v = 1u << 31, k = i; k; k >>= 1, v ^= v >> 1)
        if (k & 1) y ^= v;
    return {static_cast<float>(x >> 8) * 0x1p-24f, static_cast<float>(y >> 8) * 0x1p-24f};
}

/// Two uniform numbers from a hash.
inline Vec2f hash_point(std::uint64_t seed, std::uint64_t counter) {
    const std::uint64_t h = hash_bits(seed, counter);
    return {static_cast<float>(h >> 40) * 0x1p-24f, static_cast<float>((h >> 8) & 0xffffff) * 0x1p-24f};
}

/// Shift for the sums of pixel (x, y): a lattice, so that the errors of neighbours cancel when
/// they are averaged. `k` picks one of several independent shifts.
inline Vec2f lattice_shift(int x, int y, std::uint64_t seed, std::uint64_t k) {
    // Found by a search for the least energy, under Gaussians of 1 to 5 pixels, of the waves into
    // which the lattice folds those harmonics of a shadow edge that 4, 7 and 13 points leave.
    constexpr double a = 0.204562, b = 0.805931, c = 0.510000, d = 0.920937;
    if (k & 1) std::swap(x, y);
    if (k & 2) x = -x;
    const Vec2f start = hash_point(seed, k);
    const double u = start.x + x * a + y * b, v = start.y + x * c + y * d;
    return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

/// Returns the fractional parts of both coordinates.
inline Vec2f wrap(const Vec2f& p) {
    return p - glm::floor(p);
}

/// Uniform points of the square to the unit disc, area preserving [Shirley1997].
inline Vec2f square_to_disc(const Vec2f& s) {
    const float a = 2 * s.x - 1, b = 2 * s.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    constexpr float kQuarter = std::numbers::pi_v<float> / 4;
    if (std::abs(a) > std::abs(b)) {
        const float phi = kQuarter * b / a;
        return {a * std::cos(phi), a * std::sin(phi)};
    }
    const float phi = 2 * kQuarter - kQuarter * a / b;
    return {b * std::cos(phi), b * std::sin(phi)};
}

/// Two unit vectors that complete `n` to a right-handed frame [Duff2017].
inline void complete_frame(const Vec3f& n, Vec3f& t, Vec3f& b) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z), c = n.x * n.y * a;
    t = {1 + sign * n.x * n.x * a, sign * c, -sign * n.x};
    b = {c, sign + n.y * n.y * a, -n.y};
}

/// Direction about `n` with density cos θ / π.
inline Vec3f cosine_direction(const Vec3f& n, const Vec2f& s) {
    const Vec2f d = square_to_disc(s);
    Vec3f t, b;
    complete_frame(n, t, b);
    return d.x * t + d.y * b + std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y)) * n;
}

}  // namespace tuft::render
