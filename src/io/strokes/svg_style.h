#pragma once

#include <map>
#include <string>
#include <string_view>

#include "io/strokes/shape.h"

namespace pugi {
class xml_node;
}

/// \file
/// Presentation properties of SVG elements: attributes, `style`, style sheets. Called by svg.cpp only. Any thread.
namespace tuft::io {

/// Value of `fill` or `stroke`.
struct SvgPaint {
    enum class Kind { none, flat, white, gradient, pattern, missing } kind = Kind::none;
    std::string colour;  ///< of `flat`: as written, in lower case without blanks

    bool paints() const { return kind == Kind::flat || kind == Kind::gradient || kind == Kind::pattern; }
};

/// Properties that elements inherit from their parents.
struct SvgStyle {
    SvgPaint stroke, fill{SvgPaint::Kind::flat, "black"};
    FillRule rule = FillRule::nonzero;
    double width = 1;  ///< of lines, user units
    double fill_opacity = 1, stroke_opacity = 1;
    bool visible = true, dashed = false, marked = false;

    bool filled() const { return fill.paints() && fill_opacity > 0; }
    bool stroked() const { return stroke.paints() && stroke_opacity > 0; }
    /// Returns true for an element that is painted but gives no ink: white, transparent, or with a missing paint.
    bool bare() const {
        return !filled() && !stroked() && !(fill.kind == SvgPaint::Kind::none && stroke.kind == SvgPaint::Kind::none);
    }
};

/// Returns the text without white space at both ends.
std::string_view stripped(std::string_view text);

/// Rules of style sheets for element names, classes and ids.
class SvgSheet {
  public:
    /// Adds the rules of a sheet. Returns the number of skipped rules: at-rules and other selectors.
    std::size_t add(std::string_view sheet);
    /// Returns the properties that apply to an element besides its attributes: its `style`, else the rules for its id,
    /// its classes, its name (CSS 2.1, 6.4.3; later rules win).
    std::map<std::string, std::string> declared(const pugi::xml_node& element, const std::string& local_name) const;

  private:
    std::map<std::string, std::map<std::string, std::string>> rules_;  // by selector
};

/// Elements of a file by their `id`.
using SvgIds = std::map<std::string, pugi::xml_node>;

/// Returns the paint of a `fill` or `stroke` value. A reference to an undefined paint gives its fallback, else
/// `missing`.
SvgPaint svg_paint(const std::string& value, const SvgIds& ids);

}  // namespace tuft::io
