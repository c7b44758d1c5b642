#pragma once

#include <map>
#include <string>
#include <string_view>

#include "io/strokes/shape.h"

namespace pugi {
class xml_node;
}

/// \file
/// Presentation properties of SVG elements: attributes, `style`, style sheets.
namespace tuft::io {

/// A paint of `fill` or `stroke`.
struct SvgPaint {
    enum class Kind { none, flat, white, gradient, pattern, missing } kind = Kind::none;
    std::string colour;  ///< of `flat`: as written, in small letters without blanks

    bool paints() const { return kind == Kind::flat || kind == Kind::gradient || kind == Kind::pattern; }
};

/// What elements hand down to those within them.
struct SvgStyle {
    SvgPaint stroke, fill{SvgPaint::Kind::flat, "black"};
    FillRule rule = FillRule::nonzero;
    double width = 1;  ///< of lines, units of the drawing
    double fill_opacity = 1, stroke_opacity = 1;
    bool visible = true, dashed = false, marked = false;

    bool filled() const { return fill.paints() && fill_opacity > 0; }
    bool stroked() const { return stroke.paints() && stroke_opacity > 0; }
    /// Something is to be seen, but not as ink: white, faint to nothing, of a paint that is not
    /// there.
    bool bare() const {
        return !filled() && !stroked() && !(fill.kind == SvgPaint::Kind::none && stroke.kind == SvgPaint::Kind::none);
    }
};

/// Without white space at both ends.
std::string_view stripped(std::string_view text);

/// The rules of style sheets for element names, classes and ids.
class SvgSheet {
  public:
    /// Adds the rules of a sheet. Returns how many were passed over: at-rules and other selectors.
    std::size_t add(std::string_view sheet);
    /// What is said of an element itself outside its attributes: in its `style`, else by the rules
    /// for its id, its classes, its name (CSS 2.1, 6.4.3; rules that come later win).
    std::map<std::string, std::string> declared(const pugi::xml_node& element, const std::string& local_name) const;

  private:
    std::map<std::string, std::map<std::string, std::string>> rules_;  // by selector
};

/// Elements of a file by their `id`.
using SvgIds = std::map<std::string, pugi::xml_node>;

/// The paint that a value of `fill` or `stroke` means. A reference to a paint that the file does
/// not hold is its fallback, else `missing`.
SvgPaint svg_paint(const std::string& value, const SvgIds& ids);

}  // namespace tuft::io
