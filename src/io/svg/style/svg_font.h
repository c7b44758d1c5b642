#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/font/installed_fonts.h"

/// \file
/// Font properties of SVG text (SVG 1.1, 10; CSS Fonts). Called by svg_scene.cpp and svg_text.cpp. Any thread.
namespace tuft::io {

/// Part of a line of text that lies at its position (`text-anchor`).
enum class SvgAnchor { start, middle, end };
/// Line of the font that lies at the position (`dominant-baseline`).
enum class SvgBaseline { alphabetic, middle, central, hanging, text_top, text_bottom, mathematical };

/// Properties of text that elements inherit from their parents. Lengths in user units.
struct SvgFont {
    FontRequest face{.families = {"serif"}};
    double size = 16;  ///< the em
    double letter_spacing = 0, word_spacing = 0;
    SvgAnchor anchor = SvgAnchor::start;
    SvgBaseline baseline = SvgBaseline::alphabetic;
    double raise = 0;  ///< by `baseline-shift`, upwards; those of the parents included
    bool underline = false, overline = false, strikeout = false;
    bool vertical = false;     ///< from top to bottom, characters upright
    bool keeps_space = false;  ///< blanks are not collapsed
};

/// Value of a property of an element; empty: the element does not state it.
using SvgProperty = std::function<std::string(const char* name)>;

/// Returns true when an element states any property that `inherit_font` reads.
bool states_font(const SvgProperty& own);

/// Changes `font` by the properties of an element. Values that are not understood are passed over.
void inherit_font(SvgFont& font, const SvgProperty& own);

}  // namespace tuft::io
