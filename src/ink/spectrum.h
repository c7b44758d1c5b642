#pragma once

#include <array>

/// Colour as the ink room computes it: a few spectral bands inside, linear sRGB outside.
namespace tuft::ink {

inline constexpr int kBands = 3;
/// A number per band: reflectance, absorption or scattering.
using Bands = std::array<float, kBands>;
/// Linear light, sRGB primaries, D65.
using Rgb = std::array<float, 3>;

/// Share of each band in linear red, green and blue; rows sum to 1, so that white is white.
const std::array<Bands, 3>& band_weights();

/// Colour of a reflectance, which may lie outside the gamut.
Rgb rgb_of_bands(const Bands& reflectance);

/// A colour in [0, 1]: the nearest on the line to the grey of the same luminance.
Rgb into_gamut(const Rgb& colour);

/// A smooth reflectance of that colour; its bands lie in [0, 1].
Bands bands_of_rgb(const Rgb& colour);

}  // namespace tuft::ink
