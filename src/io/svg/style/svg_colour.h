#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

/// \file
/// Colours of SVG and CSS. Called by svg_style.cpp only. Any thread.
namespace tuft::io {

/// sRGB, encoded, and opacity, 0–1.
struct SvgColour {
    std::array<double, 3> rgb{0, 0, 0};
    double alpha = 1;

    bool operator==(const SvgColour&) const = default;
};

/// Returns a colour (CSS Color 3, and the forms without commas of CSS Color 4): one of the 147 names, `transparent`,
/// `#rgb`, `#rgba`, `#rrggbb`, `#rrggbbaa`, `rgb()`, `rgba()`, `hsl()`, `hsla()`. Nothing for any other text.
std::optional<SvgColour> svg_colour(std::string_view text);

/// Returns `#rrggbb`.
std::string hex_of(const SvgColour& colour);

}  // namespace tuft::io
