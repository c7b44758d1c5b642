#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/font/font.h"
#include "io/svg/style/svg_shapes.h"
#include "io/svg/style/svg_style.h"
#include "io/svg/svg_losses.h"

/// \file
/// Text of SVG drawings as outlines of installed fonts (SVG 1.1, 10): `tspan`, `textPath`, lists of positions, anchors,
/// `textLength`, spacing, baselines, decoration, vertical text. Called by svg_scene.cpp only. One thread at a time.
namespace tuft::io {

/// Fonts that a drawing has used so far.
class SvgFonts {
  public:
    /// Returns the font of a request that has the character, else the installed one that has it; null: no font has.
    /// Adds to `losses` a family that is not installed, once.
    Font* find(const FontRequest& request, char32_t code, SvgLosses& losses);

  private:
    Font* open(const InstalledFont& installed);

    std::map<FontRequest, InstalledFont> installed_;
    std::map<std::pair<FontRequest, char32_t>, InstalledFont> substitutes_;
    std::map<std::pair<std::string, int>, std::unique_ptr<Font>> open_;
};

/// Glyphs of one style: closed outlines, user units, nonzero rule.
struct SvgTextShape {
    SvgStyle style;
    std::vector<SvgLine> lines;
};

/// What a text takes from the drawing.
struct SvgTextContext {
    /// Style of an element inside the text, from its parent's; nothing when it is not displayed.
    std::function<std::optional<SvgStyle>(const pugi::xml_node& element, const SvgStyle& parent)> style_of;
    /// Lines of the path that a `textPath` names, user units; empty: there is none.
    std::function<std::vector<SvgLine>(const pugi::xml_node& text_path)> path_of;
    SvgFonts& fonts;
    SvgLosses& losses;
    Vec2 page{0};                         ///< user units, for per cent
    double growth = 1, tolerance = 2e-5;  ///< as in `SvgCurves`
    const std::string& source;
};

/// Returns the glyphs of a `text` element with this style, style by style in the order of their first characters. A
/// character that no installed font has is left out and counted in the losses. Throws `Error` for more than 100,000
/// characters, more than 64 nested elements and invalid numbers.
std::vector<SvgTextShape> set_svg_text(const pugi::xml_node& text, const SvgStyle& style,
                                       const SvgTextContext& context);

}  // namespace tuft::io
