#include "ink/spectra/upsample.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tuft::ink {
namespace {

constexpr int kKnots = 13;
constexpr double kFirstKnot = 390, kKnotStep = 26;  // nm, centre of the first spline
constexpr double kSmooth = 2e-3;                    // penalty on second differences
constexpr double kThickness[] = {0.12, 0.35, 0.8, 1.8, 5};
constexpr double kUnder[] = {0.9, 0.04};
constexpr int kRows = 3 * std::size(kThickness) * std::size(kUnder);

using Parameters = Eigen::Matrix<double, 2 * kKnots, 1>;
using Normal = Eigen::Matrix<double, 2 * kKnots, 2 * kKnots>;

/// exp(−x) for x ≥ 0, 2e-16 relative; std::exp may round differently with and without
/// fused multiply-adds.
double exp_minus(double x) {
    if (x > 700) return 0;
    const double n = std::floor(x * 1.4426950408889634 + 0.5);
    const double f = (n * 6.93147180369123816490e-01 - x) + n * 1.90821492927058770002e-10;
    double e = 1;
    for (int i = 14; i > 0; --i) e = 1 + e * f / i;
    return e * std::bit_cast<double>(static_cast<std::uint64_t>(1023 - static_cast<std::int64_t>(n)) << 52);
}

/// Reflectance of a film over a substrate, as `over(layer(k, s, x), under)`.
double film(double k, double s, double x, double under) {
    const double y = x * std::sqrt(k * (k + 2 * s));
    const double e = exp_minus(y), e2 = e * e;
    const double u = y < 1e-4 ? 1 - y * y / 3 : (1 - e2) / ((1 + e2) * y);
    const double d = 1 / (1 + (k + s) * x * u);
    const double r = s * x * u * d, t = 2 * e / (1 + e2) * d;
    return r + t * t * under / (1 - r * under);
}

/// Cubic B-splines over the wavelengths.
const std::array<std::array<double, kKnots>, kWavelengths>& splines() {
    static const auto table = [] {
        std::array<std::array<double, kKnots>, kWavelengths> b{};
        for (int i = 0; i < kWavelengths; ++i) {
            // Beyond the outer knots, where the eye sees nothing, the curve stays level.
            const double last = kFirstKnot + kKnotStep * (kKnots - 1);
            const double nm = std::clamp(wavelength_nm(i), kFirstKnot, last);
            double sum = 0;
            for (int j = 0; j < kKnots; ++j) {
                const double d = std::abs(nm - kFirstKnot - kKnotStep * j) / kKnotStep;
                b[i][j] = d < 1 ? 2.0 / 3 - d * d * (1 - d / 2) : d < 2 ? (2 - d) * (2 - d) * (2 - d) / 6 : 0;
                sum += b[i][j];
            }
            for (double& v : b[i]) v /= sum;
        }
        return b;
    }();
    return table;
}

/// A scale in which equal steps look about equal, for negative values too, and its slope.
constexpr double kToe = 0.006;
double scaled(double v) {
    return v / std::sqrt(std::abs(v) + kToe);
}
double slope(double v) {
    const double a = std::abs(v) + kToe;
    return (0.5 * std::abs(v) + kToe) / (a * std::sqrt(a));
}

struct Problem {
    std::array<double, kRows> goal{};
    double scale = 1;  ///< of K and S, makes the penalty independent of the unit
};

Curves curves_of(const Parameters& p) {
    Curves c;
    for (int i = 0; i < kWavelengths; ++i) {
        double a = 0, b = 0;
        for (int j = 0; j < kKnots; ++j) {
            a += splines()[i][j] * p[j];
            b += splines()[i][j] * p[kKnots + j];
        }
        c.k[i] = a * a;
        c.s[i] = b * b;
    }
    return c;
}

/// Sum of squares; with `h` and `g` also its Gauss–Newton matrix and half its gradient.
double cost(const Problem& problem, const Parameters& p, Normal* h, Parameters* g) {
    if (h) h->setZero();
    if (g) g->setZero();
    double sum = 0;
    const Curves c = curves_of(p);
    int row = 0;
    for (const double x : kThickness)
        for (const double under : kUnder) {
            std::array<double, 3> rgb{};
            Eigen::Matrix<double, 3, 2 * kKnots> jacobian;
            jacobian.setZero();
            for (int i = 0; i < kWavelengths; ++i) {
                const double k = c.k[i], s = c.s[i], r = film(k, s, x, under);
                double dk = 0, ds = 0;
                if (h) {
                    const double step = 1e-6 * (k + s + 1e-3);
                    dk = (film(k + step, s, x, under) - r) / step * 2 * std::sqrt(k);
                    ds = (film(k, s + step, x, under) - r) / step * 2 * std::sqrt(s);
                }
                for (int ch = 0; ch < 3; ++ch) {
                    const double w = rgb_matching()[ch][i];
                    rgb[ch] += w * r;
                    if (!h) continue;
                    for (int j = 0; j < kKnots; ++j) {
                        const double b = splines()[i][j];
                        if (b == 0) continue;
                        jacobian(ch, j) += w * b * dk;
                        jacobian(ch, kKnots + j) += w * b * ds;
                    }
                }
            }
            for (int ch = 0; ch < 3; ++ch, ++row) {
                const double e = scaled(rgb[ch]) - problem.goal[row];
                sum += e * e;
                if (!h) continue;
                const auto line = slope(rgb[ch]) * jacobian.row(ch);
                *h += line.transpose() * line;
                *g += line.transpose() * e;
            }
        }
    const double weight = kSmooth / problem.scale;
    for (int part = 0; part < 2; ++part)
        for (int j = 1; j + 1 < kKnots; ++j) {
            const int at = part * kKnots + j;
            const double bend = p[at - 1] - 2 * p[at] + p[at + 1];
            sum += weight * bend * bend;
            if (!h) continue;
            const double d[3] = {1, -2, 1};
            for (int a = 0; a < 3; ++a) {
                (*g)[at - 1 + a] += weight * bend * d[a];
                for (int b = 0; b < 3; ++b) (*h)(at - 1 + a, at - 1 + b) += weight * d[a] * d[b];
            }
        }
    return sum;
}

/// Where a spline's knot lies between blue, green and red.
double between(const Rgb& v, double nm) {
    const double g = std::clamp((nm - 470) / 50, 0.0, 1.0), r = std::clamp((nm - 570) / 30, 0.0, 1.0);
    return (1 - g) * v[2] + g * ((1 - r) * v[1] + r * v[0]);
}

}  // namespace

Curves upsample_pigment(const Rgb& k, const Rgb& s) {
    const double scale = std::max(*std::max_element(k.begin(), k.end()), *std::max_element(s.begin(), s.end()));
    if (!(scale > 0)) return {};
    Problem problem{.scale = scale};
    int row = 0;
    for (const double x : kThickness)
        for (const double under : kUnder)
            for (int ch = 0; ch < 3; ++ch, ++row) problem.goal[row] = scaled(film(k[ch], s[ch], x, under));
    Parameters p;
    for (int j = 0; j < kKnots; ++j) {
        const double nm = kFirstKnot + kKnotStep * j;
        // A root of zero would never move: its slope is zero.
        p[j] = std::sqrt(std::max(between(k, nm), 1e-4 * scale));
        p[kKnots + j] = std::sqrt(std::max(between(s, nm), 1e-4 * scale));
    }
    double damping = 1e-3;
    Normal h;
    Parameters g;
    double now = cost(problem, p, &h, &g);
    for (int i = 0; i < 60 && damping < 1e8; ++i) {
        Normal damped = h;
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-12;
        const Parameters next = p - damped.llt().solve(g);
        const double then = cost(problem, next, nullptr, nullptr);
        if (!(then < now)) {
            damping *= 8;
            continue;
        }
        const bool done = now - then < 1e-9 * now;
        p = next;
        if (done) break;
        damping = std::max(damping * 0.25, 1e-9);
        now = cost(problem, p, &h, &g);
    }
    return curves_of(p);
}

}  // namespace tuft::ink
