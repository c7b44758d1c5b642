#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/strokes/shape.h"
#include "io/svg/style/svg_colour.h"
#include "io/svg/style/svg_css.h"
#include "io/svg/style/svg_font.h"

namespace pugi {
class xml_node;
}

/// \file
/// Presentation properties of SVG elements. Called by svg_scene.cpp and its consumers. Any thread.
namespace tuft::io {

/// Elements of a file by their `id`.
using SvgIds = std::map<std::string, pugi::xml_node>;

/// Value of `fill` or `stroke`.
struct SvgPaint {
    enum class Kind { none, flat, white, gradient, pattern, missing } kind = Kind::none;
    std::string colour;  ///< of `flat`: as written, in lower case without blanks
    SvgColour value;     ///< of `flat` and `white`
    std::string server;  ///< id of a gradient or a pattern

    bool paints() const { return kind == Kind::flat || kind == Kind::gradient || kind == Kind::pattern; }
    bool paints_colours() const { return paints() || kind == Kind::white; }
};

/// Ends and corners of lines (SVG 1.1, 11.4).
enum class SvgCap { butt, round, square };
enum class SvgJoin { miter, round, bevel };

/// How lines are drawn, user units.
struct SvgPen {
    double width = 1;
    SvgCap cap = SvgCap::butt;
    SvgJoin join = SvgJoin::miter;
    double miter_limit = 4;      ///< at least 1: length of a miter over the width, beyond which it is cut off
    std::vector<double> dashes;  ///< an even number; empty: a solid line
    double dash_offset = 0;
};

/// Properties that elements inherit from their parents.
struct SvgStyle {
    SvgPaint stroke, fill{SvgPaint::Kind::flat, "black", {}, {}};
    SvgColour current;  ///< `color`
    FillRule rule = FillRule::nonzero, clip_rule = FillRule::nonzero;
    SvgPen pen;
    std::string marker_start, marker_mid, marker_end;  ///< ids; empty: none
    double fill_opacity = 1, stroke_opacity = 1;
    bool stroke_first = false;  ///< `paint-order`: the fill lies over the stroke
    bool visible = true;
    std::shared_ptr<const SvgFont> font;  ///< of text; null: the initial one

    bool filled() const { return fill.paints() && fill_opacity > 0; }
    bool stroked() const { return stroke.paints() && stroke_opacity > 0; }
    bool marked() const { return !marker_start.empty() || !marker_mid.empty() || !marker_end.empty(); }
    /// Returns true for an element that is painted but gives no ink: white, transparent, or with a missing paint.
    bool bare() const {
        return !filled() && !stroked() && !(fill.kind == SvgPaint::Kind::none && stroke.kind == SvgPaint::Kind::none);
    }
};

/// Returns the target of `url(#id)`, without quotes; empty for any other text.
std::string svg_reference(std::string_view value);

/// Returns the target of `href` or `xlink:href`; empty: none.
std::string svg_href(const pugi::xml_node& node);

/// Returns the paint of a `fill` or `stroke` value. A reference to an undefined paint gives its fallback, else
/// `missing`.
SvgPaint svg_paint(const std::string& value, const SvgIds& ids, const SvgColour& current);

/// Returns a number or a percentage as a part, 0–1; `otherwise` for anything else.
double svg_part(const std::string& text, double otherwise);

/// Changes a style by the presentation properties of an element; a property that it does not state stays as its
/// parent's. Throws `Error` with `source` for an invalid number.
void inherit_style(SvgStyle& style, const SvgProperty& own, const SvgIds& ids, const std::string& source);

}  // namespace tuft::io
