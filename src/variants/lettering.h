#pragma once

#include <string_view>

#include "render/brush/brush_canvas.h"

/// \file
/// Names in pictures, in the strokes of decal/stroke_font.h.
namespace tuft::variants {

/// Size and colour of a line of text.
struct LetteringOptions {
    double size = 11;    ///< pixels, height of a capital
    double width = 1e9;  ///< pixels; a longer text is made narrower down to 60 %, then cut
    Vec3 colour{0.02};   ///< linear
};

/// Returns the first words of a text that fit into a line, all of it where they do; at least one word.
std::string_view first_line(std::string_view text, const LetteringOptions& options);

/// Draws a text; `at` is the left end of its base line, pixels.
void letter(render::BrushCanvas& canvas, std::string_view text, const Vec2& at, const LetteringOptions& options = {});

}  // namespace tuft::variants
