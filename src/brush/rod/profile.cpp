#include "brush/rod/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tuft::brush {

double bending_stiffness(const Profile& p, double xi) {
    const double u = 1 + p.beta * xi;
    return std::exp(p.alpha * xi) * u * u * u + p.floor;
}

double yield_moment(const Profile& p, double xi) {
    if (p.yield <= 0) return std::numeric_limits<double>::infinity();
    const double u = 1 + p.beta * xi;
    const double own = std::exp(p.alpha * xi) * u * u * u;
    return p.yield * std::exp(p.gamma * xi) * u * u * (1 + p.floor / own);
}

Quadrature gauss_legendre(int n) {
    Quadrature q;
    q.x.resize(n);
    q.w.resize(n);
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 20; ++step) {
            double p0 = 1, p1 = x;
            for (int k = 2; k <= n; ++k) {
                const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1);
            x -= p1 / slope;
        }
        q.x[n - 1 - i] = 0.5 * (1 + x);
        q.w[n - 1 - i] = 1 / ((1 - x * x) * slope * slope);
    }
    return q;
}

double compliance(const Profile& p, double xi0, double xi1) {
    static const Quadrature rule = gauss_legendre(8);
    double sum = 0;
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
        sum += rule.w[i] / bending_stiffness(p, xi0 + (xi1 - xi0) * rule.x[i]);
    }
    return sum * (xi1 - xi0);
}

std::vector<double> spine_segments(int n, double tip_ratio) {
    std::vector<double> lengths(n, 1.0 / n);
    if (n < 2) return lengths;
    const double l1 = tip_ratio / n;
    const double d = 2 * (1 - n * l1) / (n * (n - 1.0));
    for (int i = 0; i < n; ++i) lengths[n - 1 - i] = l1 + i * d;
    return lengths;
}

namespace {

/// Antiderivatives K1, K2, K3 of e^{-cs}/s, e^{-cs}/s², e^{-cs}/s³.
struct Antiderivatives {
    double k1, k2, k3;
};

Antiderivatives antiderivatives(double c, double s) {
    if (c == 0) return {std::log(s), -1 / s, -0.5 / (s * s)};
    const double e = std::exp(-c * s);
    const double k1 = std::expint(-c * s);
    const double k2 = -e / s - c * k1;
    return {k1, k2, -e / (2 * s * s) - 0.5 * c * k2};
}

}  // namespace

SmallDeflection small_deflection(const Profile& p, double xi) {
    SmallDeflection out;
    out.moment = 1 - xi;
    if (std::abs(p.beta) < 0.05) {
        // w' = ∫ (1-t)/B dt and w = ∫ (ξ-t)(1-t)/B dt (Cauchy's repeated integral).
        static const Quadrature rule = gauss_legendre(16);
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const double t = xi * rule.x[i];
            const double f = rule.w[i] * xi * (1 - t) / bending_stiffness({p.alpha, p.beta}, t);
            out.slope += f;
            out.w += f * (xi - t);
        }
        return out;
    }
    const double beta = p.beta, c = p.alpha / beta, u = 1 + beta * xi;
    const Antiderivatives at_u = antiderivatives(c, u), at_1 = antiderivatives(c, 1);
    const double dk1 = at_u.k1 - at_1.k1, dk2 = at_u.k2 - at_1.k2, dk3 = at_u.k3 - at_1.k3;
    const double ec = std::exp(c);
    out.slope = ec / (beta * beta) * ((1 + beta) * dk3 - dk2);
    out.w = ec / (beta * beta * beta) * (u * (1 + beta) * dk3 - (u + 1 + beta) * dk2 + dk1);
    return out;
}

double elastic_limit_load(const Profile& p) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2000; ++i) {
        const double xi = i / 2000.0;
        least = std::min(least, yield_moment(p, xi) / (1 - xi));
    }
    return least;
}

namespace {

double backbone(double k) {
    return std::abs(k) <= 1 ? k : std::copysign(1.5 - 0.5 / (k * k), k);
}

}  // namespace

SectionMoment section_moment(double k1) {
    const double m = backbone(k1);
    return {m, k1 - m};
}

SectionMoment section_moment(double k1, double k2) {
    const bool past = std::abs(k2) > std::abs(k1);  // beyond the mirror point the first loading goes on
    const double m = past ? backbone(k2) : backbone(k1) - 2 * backbone((k1 - k2) / 2);
    return {m, k2 - m};
}

}  // namespace tuft::brush
