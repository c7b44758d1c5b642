#pragma once

#include <array>

#include "ink/spectra/spectrum.h"

/// \file
/// Colours from spectra, and colour differences. Used by match.h, deposit.h and the fit of the bands.
namespace tuft::ink {

inline constexpr int kWavelengths = 41;
/// Numbers at 380, 390, … 780 nm.
using Spectrum = std::array<double, kWavelengths>;
constexpr double wavelength_nm(int i) {
    return 380.0 + 10.0 * i;
}

using Xyz = std::array<double, 3>;
/// L*, a*, b* under D65.
using Lab = std::array<double, 3>;

/// Tristimulus values of a reflectance under D65, CIE 1931 2° observer, sums over 10 nm;
/// Y of a perfect white is 1. Source: [CIE2004], tables T.1 and T.4.
Xyz xyz_of_spectrum(const Spectrum& reflectance);

/// Linear sRGB (IEC 61966-2-1), each channel scaled so that a perfect white is exactly 1;
/// may lie outside [0, 1].
std::array<double, 3> rgb_of_spectrum(const Spectrum& reflectance);

/// Contribution of each wavelength to linear red, green and blue; rows sum to 1.
const std::array<Spectrum, 3>& rgb_matching();

/// The smoothest reflectance of that colour (least squared second differences); for pale
/// colours it lies in [0, 1], a grey is level. `rgb_of_spectrum` undoes it to 1e-12.
Spectrum spectrum_of_rgb(const Rgb& colour);

/// CIELAB of a linear sRGB colour, white (1, 1, 1). Negative tristimulus values count as 0.
Lab lab_of_rgb(const std::array<double, 3>& linear_rgb);

/// The inverse; channels may lie outside [0, 1].
std::array<double, 3> rgb_of_lab(const Lab& lab);

/// The terms of CIEDE2000 with unit weights: ΔE² = l² + c² + h² + r c h.
/// Source: [Sharma2005], equations 2 to 22.
struct ColourDifference {
    double l = 0, c = 0, h = 0;  ///< ΔL'/S_L, ΔC'/S_C, ΔH'/S_H
    double r = 0;                ///< R_T, in (−2, 0]
};
ColourDifference colour_difference(const Lab& a, const Lab& b);

/// CIEDE2000 with unit weights.
double delta_e_2000(const Lab& a, const Lab& b);

}  // namespace tuft::ink
