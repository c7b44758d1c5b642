#include "brush/papers/truss_force.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/cubic.h"

namespace tuft::brush::truss {

namespace {

/// A control tuple, in units of l_p and k1.
struct Tuple {
    double depth = 0, force = 0, slope = 0;
};

double force_between(const Tuple& a, const Tuple& b, double depth) {
    const double h = b.depth - a.depth;
    return hermite(a.force, b.force, a.slope, b.slope, h, (depth - a.depth) / h);
}

}  // namespace

double linear_force(double depth, double length_along, const ForceLaw& law) {
    if (depth <= 0) return 0;
    if (depth <= length_along) return law.bristles * depth / length_along;
    return law.bristles + law.handle * (depth - length_along) / length_along;
}

double compressive_share(double tilt) {
    if (std::abs(tilt) >= 0.25 * std::numbers::pi) return 0;
    const double c = std::cos(2 * tilt);
    return c * c;
}

double head_force(double depth, double length_along, double tilt, const ForceLaw& law) {
    if (depth <= 0) return 0;
    const double gamma = compressive_share(tilt), stiff = law.handle / law.bristles, d = depth / length_along;
    const std::array<Tuple, 5> tuples{{{0, 0, 1 + 5 * gamma},
                                       {0.08, 0.08 + 0.35 * gamma, 0},
                                       {0.35, 0.35, 0.8},
                                       {1, 1, 1.2},
                                       {1.15, 1 + 0.15 * stiff, stiff}}};
    for (std::size_t k = 0; k + 1 < tuples.size(); ++k)
        if (d < tuples[k + 1].depth) return law.bristles * force_between(tuples[k], tuples[k + 1], d);
    return law.bristles * (tuples.back().force + stiff * (d - tuples.back().depth));
}

}  // namespace tuft::brush::truss
