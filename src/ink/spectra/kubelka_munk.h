#pragma once

#include <span>

/// \file
/// Kubelka–Munk optics of one wavelength band: the appearance of an absorbing and scattering film over a substrate.
/// Diffuse light, no fluorescence. Used by composite.h and match.h. Source: [Kubelka1931],
/// [Kubelka1948] (layers), [Kubelka1954] (stacks), [Saunderson1942].
///
/// K and S are absorption and scattering per film unit. X is the thickness in film units (one unit is 10 µm of wet
/// ink, about 5 g/m² when dry). Reflectances and transmittances are linear, in [0, 1]. Every function is finite for
/// K, S, X from 0 to 1e100 and needs no special case by the caller.
namespace tuft::ink {

/// Reflectance and transmittance of a layer or of a stack of layers.
struct Layer {
    double r = 0;       ///< reflectance from above, over black
    double t = 1;       ///< transmittance, the same both ways
    double r_back = 0;  ///< reflectance from below; equals r for a single layer
};

/// Absorption and scattering of a film unit.
struct Coefficients {
    double k = 0;  ///< absorption per film unit
    double s = 0;  ///< scattering per film unit
};

/// R0 = sinh bSX / (a sinh bSX + b cosh bSX), T = b / (the same), with a = 1 + K/S and
/// b² = a² − 1. Evaluated as R0 = SX u / (1 + (K+S)X u), T = sech y / (1 + (K+S)X u) with
/// y = X √(K (K+2S)) and u = tanh y / y, which has no pole at K = 0 or S = 0.
/// Negative arguments are taken as 0.
Layer layer(double k, double s, double x);

/// Reflectance of a layer over a substrate: R0 + T² Rg / (1 − R_back Rg).
double over(const Layer& top, double r_substrate);

/// `top` laid on `bottom`. Associative.
Layer stack(const Layer& top, const Layer& bottom);

/// Reflectance of an infinitely thick film: 1 + K/S − √((K/S)² + 2 K/S). S = 0 and K > 0
/// give 0; K = 0 gives 1, or 0 when S is 0 too (an empty film shows nothing).
double r_infinity(double k, double s);

/// Mixture in one film: K = Σ c K_i, S = Σ c S_i; `parts` and `fractions` have one length.
Coefficients mixture(std::span<const Coefficients> parts, std::span<const double> fractions);

/// K and S per film unit from the reflectances of a film of thickness 1 over ideal
/// white (1) and ideal black (0). Needs 0 < r_black ≤ r_white < 1; throws `Error` otherwise
/// or when no film looks like that.
Coefficients from_white_and_black(double r_white, double r_black);

/// Reflection at the air side of a glaze or varnish.
struct Interface {
    double k1 = 0.04;  ///< Fresnel reflectance from air
    double k2 = 0.6;   ///< diffuse reflectance back into the film
};

/// Saunderson's correction R' = k1 + (1−k1)(1−k2) R / (1 − k2 R). With
/// `specular_included` false the term k1 is left out (measured without the gloss).
double saunderson(double r, const Interface& interface = {}, bool specular_included = true);

/// The film reflectance that `saunderson` takes to `r_measured`.
double saunderson_inverse(double r_measured, const Interface& interface = {}, bool specular_included = true);

}  // namespace tuft::ink
