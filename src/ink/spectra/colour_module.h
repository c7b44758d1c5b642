#pragma once

#include "ink/spectra/colour_space.h"

/// \file
/// What the module `tuft_colour` offers: conversions between colour spaces by OpenColorIO, whose types stay
/// in colour_module.cpp. Called by colour_space.cpp only.
namespace tuft::ink {

/// Linear sRGB to linear RGB of a space, and back.
struct ColourMatrices {
    Matrix3 from_srgb{}, to_srgb{};
};

/// Returns nothing where it is done, else why not, as text that stays.
using ColourConversion = const char* (*)(ColourSpace space, ColourMatrices& out);
inline constexpr const char* kColourSymbol = "tuft_colour_matrices";

}  // namespace tuft::ink
