#pragma once

#include "ink/spectra/colorimetry.h"

/// \file
/// Spectra of pigments that are known in red, green and blue only. Called by pigments.h.
namespace tuft::ink {

/// Absorption and scattering per film unit, by wavelength.
struct Curves {
    Spectrum k{}, s{};
};

/// Smooth absorption and scattering over wavelength such that films of 0.1–6 film units over
/// white and over black have the colours that Kubelka–Munk gives in three linear RGB bands.
/// K = p², S = q² with p and q cubic splines of 13 knots; Levenberg–Marquardt on the colours
/// in a square-root scale with a penalty on the splines' second differences. Only operations
/// that round alike everywhere are used, so the result has the same bits on every machine.
/// About 3 ms. `k`, `s` ≥ 0, per film unit.
Curves upsample_pigment(const Rgb& k, const Rgb& s);

}  // namespace tuft::ink
