#pragma once

/// \file
/// Capillary rise of ink in the hair of a dipped tuft. `stroke` calls it for dips of a given time.
namespace tuft::ink {

/// Ink between the hairs of a tuft.
struct Uptake {
    double surface_tension = 0.05;  ///< N/m, γ
    double viscosity = 2e-3;        ///< Pa·s, η
    double pore_radius = 5e-5;      ///< m, r, of the tubes between the hairs; see `pore_radius_of`
    double slope = 1;               ///< fraction of its weight against the rise: 1 upright, 0 horizontal
};

/// Returns by how far ink has risen over the level of the dish after `seconds`, metres. Capillary pressure 2 γ/r drives
/// it through tubes of radius r,
///
///     8 η h h'/r² = 2 γ/r − slope ρ g h,
///
/// so that h² = γ r t/(2 η) at first or lying ([Lucas1918], [Washburn1921]), and never more than 2 γ/(slope ρ g r)
/// [Jurin1718]. Relative error 1e-9.
double uptake_height(const Uptake& uptake, double seconds);

/// Returns the radius of a tube with the suction of packed hair, metres: (1 − φ) d/(2 φ) [Princen1969], with the
/// diameter d of a hair and the part φ = 0.55 of the tuft that is hair.
double pore_radius_of(double hair_diameter);

}  // namespace tuft::ink
