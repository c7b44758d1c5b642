#pragma once

#include <string>

#include "decal/sheet.h"

/// \file
/// What stands on a page besides the pieces: registration marks, scale bar, grain, foot, and the label of a piece. Used
/// by sheet.cpp.
namespace tuft::decal {

inline constexpr double kPageMargin = 0.010;   ///< metres, free of pieces; holds the registration marks
inline constexpr double kFootHeight = 0.014;   ///< metres, of the scale bar and the text below the pieces
inline constexpr double kLabelHeight = 0.009;  ///< metres, of the box of a number and its arrow

/// Returns the size and the lower left corner of the part of a page that takes pieces, metres. Of a roll the height is
/// 0.
Vec2 free_area(const Vec2& page);
Vec2 free_origin();
/// Returns the length of a roll whose pieces end at height `used`.
double roll_length(double used);

/// Returns the width of a piece's number on the page, metres.
double label_width(int number);
/// Draws a number and an arrow that points along `up` (unit, on the page) into the box at `at`.
void add_label(Page& page, int number, const Vec2& at, const Vec2& up);

/// What the foot of a page states.
struct FootText {
    std::string title;
    std::size_t page = 1, pages = 1;
    double strain = 0;  ///< largest of the page's pieces
    double limit = 0;   ///< of the strain
};
/// Draws registration marks, scale bar with millimetres, grain (along the page's height) and the foot; on a strain map
/// the colours with their strains, too.
void add_marks(Page& page, const FootText& text);

}  // namespace tuft::decal
