#include "ink/exchange/uptake.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink {

namespace {

constexpr double kWeight = 9810;    ///< ρ g of water, N/m³
constexpr double kHairPart = 0.55;  ///< φ
constexpr double kNoRise = 1e-4;    ///< part of the greatest height up to which weight plays no part to 1e-4
constexpr int kMostSteps = 60;

}  // namespace

double uptake_height(const Uptake& u, double seconds) {
    if (!(seconds > 0) || !(u.pore_radius > 0)) return 0;
    const double lying = std::sqrt(u.surface_tension * u.pore_radius * seconds / (2 * u.viscosity));
    if (u.slope <= 0) return lying;
    // With x = h over the greatest height: −x − ln(1 − x) = time, in units of 8 η h_max²/(2 γ r).
    const double most = 2 * u.surface_tension / (u.slope * kWeight * u.pore_radius);
    const double time = 0.5 * (lying / most) * (lying / most);
    double lo = 0, hi = std::min(1.0, lying / most);
    if (hi < kNoRise) return lying * (1 - hi / 3);
    for (int i = 0; i < kMostSteps; ++i) {
        const double x = 0.5 * (lo + hi);
        (-x - std::log1p(-x) < time ? lo : hi) = x;
    }
    return most * lo;
}

double pore_radius_of(double hair_diameter) {
    return (1 - kHairPart) * hair_diameter / (2 * kHairPart);
}

}  // namespace tuft::ink
