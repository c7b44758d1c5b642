#pragma once

#include <array>

/// \file
/// Colour as the ink module computes it: a few spectral bands inside, linear sRGB outside.
namespace tuft::ink {

/// Chosen by `tests/ink/fit_bands.cpp`: against sums over 41 wavelengths the colours of 20,000
/// random mixes, thicknesses and stacks differ by 0.02 ΔE2000 in the mean, by 0.2 at worst.
inline constexpr int kBands = 24;
/// A number per band: reflectance, absorption or scattering.
using Bands = std::array<float, kBands>;
/// Linear light, sRGB primaries, D65.
using Rgb = std::array<float, 3>;

/// Wavelengths of the bands, nm: K and S of a pigment are taken there.
const Bands& band_nm();

/// Share of each band in linear red, green and blue; rows sum to 1, so that white is white.
const std::array<Bands, 3>& band_weights();

/// Colour of a reflectance, which may lie outside the gamut.
Rgb rgb_of_bands(const Bands& reflectance);

/// A colour in [0, 1]: the nearest on the line to the grey of the same luminance.
Rgb into_gamut(const Rgb& colour);

/// Bands of the three primaries: a colour's bands are its sum of these, cut to [0, 1].
const std::array<Bands, 3>& primary_bands();

/// A smooth reflectance of that colour; its bands lie in [0, 1]. `rgb_of_bands` undoes it to
/// 1e-6 unless the colour is so deep that the bands had to be cut.
Bands bands_of_rgb(const Rgb& colour);

}  // namespace tuft::ink
