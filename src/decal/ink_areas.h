#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "decal/print.h"

/// \file
/// Paint as areas of one ink with exact borders, for screens, pads and cutters. Called by sheet.h.
namespace tuft::decal {

/// Returns where the coverage of a piece is above a half, in the panel's plane: inside `film` and, of the paint within
/// `bleed` metres of it, what hangs together with that. Rings are level lines of the coverage, which is sampled half a
/// `texel` apart, wider where that were more than 16 million samples; between samples the line is found by bisection.
/// So a line one texel wide stays. The stairs of texels are taken out by `smooth_ring`. Areas and holes of less than a
/// quarter of a texel are left out.
Region find_ink_area(const PrintSurface& surface, const CoverageFn& coverage, const Region& film, double bleed,
                     double texel);

/// The one ink of a piece.
struct PrintedInk {
    std::vector<double> mix;                ///< [n_plates] parts of the pigments, sum 1
    std::array<double, 3> colour{0, 0, 0};  ///< 0–1, coded as `PrintImage::rgb`, mean by coverage
    double weight = 0;                      ///< covered area, m²
};

/// Returns the ink of a piece if it has one: the mean of ½ Σ |part − mean part| is at most 2 %, thick film counts no
/// more than a quarter of the thickest.
std::optional<PrintedInk> find_single_ink(const PaintSamples& samples);

/// Returns whether two mixes differ by at most 2 %.
bool is_same_mix(std::span<const double> a, std::span<const double> b);

}  // namespace tuft::decal
