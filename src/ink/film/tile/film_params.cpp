#include "ink/film/tile/film_params.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::ink {
namespace {

constexpr double kLeastMixing = 2e-10;            // m²/s
constexpr double kStirring = 0.02;                // film units: mixing over mobility
constexpr double kOfClouds = 1, kOfFibres = 1.3;  // of unevenness, on relief that is far higher than kFilmHeight
constexpr double kFilmHeight = 10e-6;             // metres: relief over which flow is as uneven as half of that
// Still air at 20 °C and half its humidity [HuLarson2002]: D (c_s − c_∞) / ρ, m²/s, for the rate that substrates have.
constexpr double kVapour = 24.2e-6 * 17.3e-3 * 0.5 / 1000, kRateInStillAir = 1.0 / 60;
constexpr double kRimLength = 1e-3;  // metres: what the rim of a wet spot adds to its area, as for drying

/// Without a radius of its pores, `diffusion` is that of full pores.
double suction_of(const Wetting& wetting, const FilmParams& p) {
    if (wetting.pore_radius > 0)
        return washburn(static_cast<double>(wetting.pore_radius),
                        static_cast<double>(wetting.contact_angle) * std::numbers::pi / 180, p.ripples.tension,
                        p.ripples.viscosity);
    return kFrontConstant * kFrontConstant * p.mobility * p.pores.capacity;
}

}  // namespace

double washburn(double pore_radius, double contact_angle, double tension, double viscosity) {
    return pore_radius * tension * std::cos(contact_angle) / (2 * viscosity);
}

FilmParams film_params(const Substrate& substrate, const Vec3& down) {
    const Wetting& wetting = substrate.wetting;
    FilmParams p;
    p.mobility = static_cast<double>(wetting.diffusion);
    // Wet in wet, surface tension stirs more than molecules move: as wide as water itself spreads.
    p.mixing = std::max(kLeastMixing, kStirring * p.mobility);
    p.threshold = static_cast<double>(wetting.threshold);
    p.pin = 2 * static_cast<double>(wetting.edge);
    p.pores.absorbency = static_cast<double>(wetting.absorbency);
    p.pores.capacity = static_cast<double>(wetting.pores);
    p.pores.suction = suction_of(wetting, p);
    p.pores.retention = static_cast<double>(wetting.retention);
    p.drying.evaporation = static_cast<double>(wetting.evaporation);
    p.drying.rim_evaporation = p.drying.evaporation * static_cast<double>(wetting.edge) * kRimLength;
    p.drying.still_air = static_cast<double>(wetting.still_air);
    p.drying.vapour = kVapour / kFilmUnit * (p.drying.evaporation / kRateInStillAir);
    p.drying.stain = p.pores.capacity / (p.pores.capacity + 2);
    if (wetting.pores > 0)
        p.unevenness = (kOfClouds + kOfFibres * p.pores.retention) * static_cast<double>(substrate.relief) /
                       (static_cast<double>(substrate.relief) + kFilmHeight);
    p.weight.hysteresis = static_cast<double>(wetting.line_hysteresis);
    if (glm::length(down) > 0) p.weight.down = glm::normalize(down);
    return p;
}

}  // namespace tuft::ink
