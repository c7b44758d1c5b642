#pragma once

#include <algorithm>
#include <array>
#include <cmath>

/// \file
/// Cubic Hermite curves through nodes, and slopes at the nodes. The surfaces of tufts, the outline of a contact, tables
/// of bent tufts, the times of poses and lines of characters are made of them. T is a number or a vector.
namespace tuft {

/// Returns the cubic with values p0, p1 and slopes m0, m1 at the ends of a piece of length h, at t in [0, 1] of it:
/// p0 + (p1 − p0)(3t² − 2t³) + h (m0 (t³ − 2t² + t) + m1 (t³ − t²)). p0 to the bit at t = 0; p1 within rounding at
/// t = 1.
template <class T>
T hermite(const T& p0, const T& p1, const T& m0, const T& m1, double h, double t) {
    const double t2 = t * t, t3 = t2 * t;
    return p0 + (p1 - p0) * (3 * t2 - 2 * t3) + h * (m0 * (t3 - 2 * t2 + t) + m1 * (t3 - t2));
}

/// Returns the same by slopes over the whole piece, h m0 and h m1, in a form that is exact at both ends.
inline double hermite_between(double p0, double p1, double m0, double m1, double t) {
    const double r = 1 - t;
    return r * r * (1 + 2 * t) * p0 + t * t * (1 + 2 * r) * p1 + r * t * (r * m0 - t * m1);
}

/// Returns the slope of `hermite`, per unit of h: 6 (p1 − p0)(t − t²) / h + m0 (3t² − 4t + 1) + m1 (3t² − 2t).
template <class T>
T hermite_slope(const T& p0, const T& p1, const T& m0, const T& m1, double h, double t) {
    const double t2 = t * t;
    return (p1 - p0) * (6 * (t - t2) / h) + m0 * (3 * t2 - 4 * t + 1) + m1 * (3 * t2 - 2 * t);
}

/// Returns Bernstein's polynomials C(3, k) t^k (1 − t)^{3−k}: the weights of the control points of a Bézier curve at t.
inline std::array<double, 4> bernstein(double t) {
    const double s = 1 - t;
    return {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
}

/// Returns the slope at a node of the parabola through it and its neighbours, from the slopes of the chords on both
/// sides and their lengths.
template <class T>
T parabola_slope(const T& before, const T& after, double h_before, double h_after) {
    return (h_after * before + h_before * after) / (h_before + h_after);
}

/// Returns the same, limited so that the cubics on both sides are monotone where the nodes are [Fritsch1980]: at most
/// three times the flatter chord, 0 at an extreme.
inline double monotone_slope(double before, double after, double h_before, double h_after) {
    if (!(before * after > 0)) return 0;
    const double most = 3 * std::min(std::abs(before), std::abs(after));
    return std::clamp(parabola_slope(before, after, h_before, h_after), -most, most);
}

}  // namespace tuft
