#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "ink/spectra/spectrum.h"

/// \file
/// RGB colour spaces of pictures. The bands of a paint become linear sRGB outside its gamut first and the space's
/// primaries by one matrix then, so nothing is cut before the space of the file. Called by composite.h and by the
/// writers of `io`.
///
/// The matrix between linear sRGB and a space is OpenColorIO's: RGB' = N'⁻¹ A N RGB, where N is the matrix of
/// a space's linear RGB to XYZ, by its chromaticities and white, and A the Bradford adaptation of whites (ICC.1:2010,
/// annex E; [Lam1985]). N and A of this header are what ICC profiles hold.
namespace tuft::ink {

/// A space that pictures are stored in.
enum class ColourSpace {
    srgb,        ///< IEC 61966-2-1
    display_p3,  ///< primaries of SMPTE RP 431-2, white D65, curve of sRGB
    acescg,      ///< AP1 of ACES (S-2014-004), white of ACES, linear
};

/// Rows of a matrix that multiplies a column.
using Matrix3 = std::array<std::array<double, 3>, 3>;

/// CIE 1931 chromaticity.
struct Chromaticity {
    double x = 0, y = 0;
};

/// Name, primaries and white of a colour space.
struct ColourSpaceData {
    std::string_view name;  ///< srgb, display-p3, acescg
    std::string_view title;
    Chromaticity red, green, blue, white;
    bool linear = false;  ///< stored values are linear; else by the curve of sRGB
};

/// Returns the data of a space.
const ColourSpaceData& data_of(ColourSpace space);
/// The space of that name, or nothing.
std::optional<ColourSpace> colour_space_named(std::string_view name);
std::vector<std::string_view> colour_space_names();

/// Linear RGB of the space to XYZ; Y of (1, 1, 1) is 1.
Matrix3 xyz_of_linear(ColourSpace space);
/// The same, adapted to D50, as ICC profiles store it.
Matrix3 xyz_d50_of_linear(ColourSpace space);
/// Bradford adaptation of XYZ from the white of the space to D50.
Matrix3 adaptation_to_d50(ColourSpace space);
/// Linear sRGB to linear RGB of the space, and back. White stays white; for sRGB the identity, exactly. The first call
/// for another space loads OpenColorIO. \throw Error where it cannot be loaded.
const Matrix3& from_linear_srgb(ColourSpace space);
const Matrix3& to_linear_srgb(ColourSpace space);

/// Stored value in [0, 1] of a linear one: by the space's curve.
float encode(ColourSpace space, float linear);

/// The product of a matrix and a colour.
Rgb transform(const Matrix3& matrix, const Rgb& colour);

/// A colour of the space in [0, 1]: the nearest on the line to the grey of the same luminance.
Rgb into_gamut(const Rgb& colour, ColourSpace space);

}  // namespace tuft::ink
