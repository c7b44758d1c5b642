#pragma once

#include <cstdint>
#include <vector>

#include "ink/spectra/colour_space.h"

/// \file
/// ICC profiles of the colour spaces, for PNG and PDF. Called by the writers of `io` and by `tuft decals`.
namespace tuft::io {

/// Returns the bytes of a display profile by matrix and curves, version 4.2 (ICC.1:2004-10). Colourants are adapted to
/// D50 by Bradford (tag chad); the curve is that of sRGB (parametric, type 3) or linear (type 0, exponent 1). Numbers
/// are rounded to 1/65536. The same space gives the same bytes. About 700 bytes.
std::vector<std::uint8_t> icc_profile(ink::ColourSpace space);

}  // namespace tuft::io
