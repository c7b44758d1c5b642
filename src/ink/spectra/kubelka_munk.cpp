#include "ink/spectra/kubelka_munk.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"

namespace tuft::ink {

Layer layer(double k, double s, double x) {
    k = std::max(k, 0.0);
    s = std::max(s, 0.0);
    x = std::max(x, 0.0);
    const double y = std::sqrt(k) * std::sqrt(k + 2 * s) * x;
    const double u = y < 1e-4 ? 1 - y * y / 3 : std::tanh(y) / y;
    const double e = std::exp(-y);
    const double sech = 2 * e / (1 + e * e);
    const double denominator = 1 + (k + s) * x * u;
    const double r = s * x * u / denominator;
    return {.r = r, .t = sech / denominator, .r_back = r};
}

double over(const Layer& top, double r_substrate) {
    const double open = 1 - top.r_back * r_substrate;
    return open > 0 ? top.r + top.t * top.t * r_substrate / open : top.r;
}

Layer stack(const Layer& top, const Layer& bottom) {
    const double open = 1 - top.r_back * bottom.r;
    if (!(open > 0)) return {.r = top.r, .t = 0, .r_back = bottom.r_back};
    return {.r = top.r + top.t * top.t * bottom.r / open,
            .t = top.t * bottom.t / open,
            .r_back = bottom.r_back + bottom.t * bottom.t * top.r_back / open};
}

double r_infinity(double k, double s) {
    if (s <= 0) return 0;
    // The conjugate of 1 + q − √(q² + 2q): no cancellation for large q = K/S.
    const double q = std::max(k, 0.0) / s;
    return 1 / (1 + q + std::sqrt(q) * std::sqrt(q + 2));
}

Coefficients mixture(std::span<const Coefficients> parts, std::span<const double> fractions) {
    assert(parts.size() == fractions.size());
    Coefficients sum;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        sum.k += fractions[i] * parts[i].k;
        sum.s += fractions[i] * parts[i].s;
    }
    return sum;
}

Coefficients from_white_and_black(double r_white, double r_black) {
    const auto refuse = [&] {
        throw Error(Message("no film has reflectance {} over white and {} over black", r_white, r_black));
    };
    if (!(r_black > 0 && r_black <= r_white && r_white < 1)) refuse();
    const double a = 0.5 * (r_white + (r_black - r_white + 1) / r_black);
    if (!(a > 1)) refuse();
    const double b = std::sqrt((a - 1) * (a + 1));
    const double coth = (b * b - (a - r_white) * (a - 1)) / (b * (1 - r_white));
    if (!(coth > 1)) refuse();
    const double s = 0.5 * std::log((coth + 1) / (coth - 1)) / b;
    return {.k = s * (a - 1), .s = s};
}

double saunderson(double r, const Interface& interface, bool specular_included) {
    const auto [k1, k2] = interface;
    return (specular_included ? k1 : 0.0) + (1 - k1) * (1 - k2) * r / (1 - k2 * r);
}

double saunderson_inverse(double r_measured, const Interface& interface, bool specular_included) {
    const auto [k1, k2] = interface;
    const double m = r_measured - (specular_included ? k1 : 0.0);
    return m / ((1 - k1) * (1 - k2) + k2 * m);
}

}  // namespace tuft::ink
