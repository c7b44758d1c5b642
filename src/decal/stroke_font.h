#pragma once

#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Numbers and capital letters in single strokes, for sheets and pictures: no font has to be there, and plotters draw
/// them.
namespace tuft::decal {

/// Returns the lines of a text with capitals `size` high; `at` is the left end of the base line, y up. Small letters
/// are drawn as capitals. Other characters that are not 0–9, A–Z, space or one of -.,:/%+=()_#* are boxes.
std::vector<std::vector<Vec2>> text_lines(std::string_view text, const Vec2& at, double size);

/// Returns the width of the text.
double text_width(std::string_view text, double size);

}  // namespace tuft::decal
