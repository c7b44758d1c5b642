#pragma once

#include <string>
#include <vector>

#include "io/svg/style/svg_shapes.h"

namespace pugi {
class xml_node;
}

/// \file
/// Lengths, frames and basic shapes of SVG drawings (SVG 1.1, chapters 7 and 9). Called by svg_scene.cpp. Any thread.
namespace tuft::io {

inline constexpr double kSvgPixel = 0.0254 / 96;  ///< metres of a CSS pixel

/// Returns a length with its unit, metres; 0: none, or a part of an unknown page.
double svg_length(const std::string& text, const std::string& source);
/// Returns an attribute in user units; per cent are of the page (user units). 0 where there is none.
double svg_number(const pugi::xml_node& node, const char* name, const Vec2& page, const std::string& source);
/// Returns `stroke-dasharray` in user units, an even number of lengths; empty: a solid line.
std::vector<double> svg_dashes(const std::string& text, const std::string& source);
/// Returns the growth of lengths by a matrix: the root of its area's.
double svg_growth(const SvgMatrix& matrix);

/// The outermost frame.
struct SvgPage {
    SvgMatrix frame{1};  ///< user units to metres; the corner of the viewBox becomes (0, 0)
    Vec2 view{0};        ///< user units
    Vec2 size{0};        ///< metres
};
SvgPage svg_page(const pugi::xml_node& svg, const std::string& source);

/// A rectangle that an inner drawing fills, user units.
struct SvgViewport {
    Vec2 corner{0}, size{0};
};
/// Frame of an inner drawing.
struct SvgFraming {
    SvgMatrix matrix{1};  ///< from the inner drawing to the user space of the viewport
    Vec2 view{0};         ///< size of the inner page, its units
};
/// Returns the frame of an element with `viewBox` and `preserveAspectRatio` in a viewport (SVG 1.1, 7.8); without
/// `viewBox` its corner alone.
SvgFraming svg_framing(const pugi::xml_node& node, const SvgViewport& port, const std::string& source);

/// Returns the lines of a basic shape or path; none for another element. User units. Throws `Error` for invalid data;
/// with `damaged`, a path with a fault ends before it (SVG 1.1, F.2) and sets `damaged` instead.
std::vector<SvgLine> svg_lines(const pugi::xml_node& node, const std::string& name, const SvgCurves& curves,
                               const Vec2& page, const std::string& source, bool* damaged = nullptr);
/// The same in the user space round the element, by its `transform`.
std::vector<SvgLine> svg_transformed_lines(const pugi::xml_node& node, const SvgCurves& curves, const Vec2& page,
                                           const std::string& source);

}  // namespace tuft::io
