#pragma once

#include <cstdint>
#include <functional>

#include "core/geometry/types.h"
#include "ink/canvas/canvas.h"

/// \file
/// Parameters of the wet film (film.h).
namespace tuft::ink {

/// ξ: where liquid is supplied, a front in the pores is at ξ √(D₀ t). From (S² S′)′ = −½ ξ S′, S(0) = 1.
inline constexpr double kFrontConstant = 1.0903204;

/// Returns the free fraction of a texel, 0–255, from the mask.
using FreeTexelsFn = std::function<std::uint8_t(std::uint32_t slot, int texel)>;

/// Liquid in the pores of a substrate.
struct FilmPores {
    double absorbency = 0;  ///< a, 1/s: absorption by empty pores
    double capacity = 0;    ///< film units; 0: no pores
    double suction = 0;     ///< k, m²/s: a front fed from full pores is at √(k t); 0: nothing seeps
    double retention = 0;   ///< fraction of the pigments that pores retain from seeping liquid
};

/// What dries, and what it leaves.
struct FilmDrying {
    double evaporation = 1.0 / 60;  ///< film units per second
    double rim_evaporation = 0;     ///< film units · m per second, additional, per metre of rim
    double rim_depth = 1;           ///< film units: rims are thinner than this
    double stain = 0;               ///< fraction of a drying film that soaks into bare substrate
    /// D (c_s − c_∞) / ρ over a film unit, film · m/s: still air takes up 4 R of it from a spot of radius R
    /// (still_air.h), which the rates share out.
    double vapour = 0;
    double still_air = 0;  ///< m: thickness of the still air over the surface; 0: it moves, and the rates hold anywhere
    bool goes_on = false;  ///< this call follows the one before: what was found of the air then still holds
};

/// Levelling of ripples by surface tension.
struct FilmRipples {
    bool level = true;        ///< in this call; false: the caller counts the time, see `unlevelled`
    double unlevelled = 0;    ///< s before this call in which ripples have not levelled yet
    double tension = 0.06;    ///< σ, N/m: between water (0.073) and water with glue (0.05); 0: ripples stay
    double viscosity = 1e-3;  ///< η, Pa s, of water; pigments and glue make some inks several times as viscous
    double held = 0.3;        ///< film units: so thin a film is held by its contact line and does not level
};

/// Weight of the liquid, and the beads that run down.
struct FilmWeight {
    Vec3 down{0};              ///< unit, direction of gravity; zero: none
    double bead_angle = 0.15;  ///< radians: contact angle of a bead
    double bead_speed = 8e-3;  ///< m/s, speed of a bead of √2 times the radius at which it stops
    double drain = 2;          ///< 1/s: rate at which a bead draws in near liquid above `FilmParams::retained`
    double trail = 0.9;        ///< film units that a bead leaves behind
    /// cos θ_r − cos θ_a of lines that recede and advance: what holds a sheet, over σ a metre; 0.08 at 5° and 24°. 0:
    /// no sheets run, beads take what is too heavy.
    double hysteresis = 0;
};

/// How liquid behaves on a surface. Amounts of liquid in film units (10 µm). Every number is finite and ≥ 0, fractions
/// are ≤ 1; `film_params` fills them.
struct FilmParams {
    double mobility = 1e-10;  ///< D, m²/s per film unit of water
    double threshold = 0.1;   ///< w_c: film units held by the surface
    double pin = 1;           ///< film units above w_c needed to wet dry surface
    double mixing = 1e-10;    ///< D_p, m²/s: diffusion of the pigments in the liquid
    double grip = 1;          ///< film units: in thinner liquid, pigment lies on the surface and lags behind
    double unevenness = 0;    ///< rms of ln of the relative mobility over the ground; 0: even
    double retained = 2;      ///< w_r: film units not moved by gravity or surface tension
    double levelling = 1e-8;  ///< L, m²/s per film unit above `retained`: spreading onto dry surface
    double ridge = 0.4;       ///< film units that stay on the ridges of dry paint
    /// Seconds; a fifth on relief, half under liquid. Where stability needs shorter steps, the fastest flows are
    /// limited, or computed between blocks of texels; beside seams such steps are divided.
    double shortest_step = 0.05;
    FilmPores pores;
    FilmDrying drying;
    FilmRipples ripples;
    FilmWeight weight;
};

/// Returns k = r σ cos θ / (2 η), m²/s: the square of the length of a front in pores of radius r (m) over time, with
/// contact angle θ (radians), σ (N/m) and η (Pa s) ([Lucas1918], [Washburn1921]).
double washburn(double pore_radius, double contact_angle, double tension, double viscosity);

/// Returns the parameters of a substrate (diffusion, threshold, edge, absorbency, pores, pore radius, contact angle,
/// evaporation, relief) and the direction of gravity. Where no pore radius is given, full pores have the diffusion of
/// the film: k = ξ² D pores.
FilmParams film_params(const Substrate& substrate, const Vec3& down = Vec3{0});

}  // namespace tuft::ink
