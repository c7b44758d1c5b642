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
constexpr double kRimLength = 1e-3;               // metres: what the rim of a wet spot adds to its area, as for drying

/// Without a radius of its pores, `diffusion` is that of full pores.
double suction_of(const Substrate& substrate, const FilmParams& p) {
    if (substrate.pore_radius > 0)
        return washburn(static_cast<double>(substrate.pore_radius),
                        static_cast<double>(substrate.contact_angle) * std::numbers::pi / 180, p.tension, p.viscosity);
    return kFrontConstant * kFrontConstant * p.mobility * p.pores;
}

}  // namespace

double washburn(double pore_radius, double contact_angle, double tension, double viscosity) {
    return pore_radius * tension * std::cos(contact_angle) / (2 * viscosity);
}

FilmParams film_params(const Substrate& substrate, const Vec3& down) {
    FilmParams p;
    p.mobility = static_cast<double>(substrate.diffusion);
    // Wet in wet, surface tension stirs more than molecules move: as wide as water itself spreads.
    p.mixing = std::max(kLeastMixing, kStirring * p.mobility);
    p.threshold = static_cast<double>(substrate.threshold);
    p.pin = 2 * static_cast<double>(substrate.edge);
    p.absorbency = static_cast<double>(substrate.absorbency);
    p.pores = static_cast<double>(substrate.pores);
    p.suction = suction_of(substrate, p);
    p.retention = static_cast<double>(substrate.retention);
    p.evaporation = static_cast<double>(substrate.evaporation);
    p.rim_evaporation = p.evaporation * static_cast<double>(substrate.edge) * kRimLength;
    p.stain = p.pores / (p.pores + 2);
    if (substrate.pores > 0)
        p.unevenness = (kOfClouds + kOfFibres * p.retention) * static_cast<double>(substrate.relief) /
                       (static_cast<double>(substrate.relief) + kFilmHeight);
    if (glm::length(down) > 0) p.down = glm::normalize(down);
    return p;
}

}  // namespace tuft::ink
