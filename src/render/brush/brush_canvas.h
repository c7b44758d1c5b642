#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Small antialiased drawing surface for pictures of brushes. Coordinates are in pixels, x right, y down; pixel (i,
/// j) covers [i, i+1] × [j, j+1]. Colours are linear, 0 to 1.
///
/// Cairo 1.16 draws 1500 tapered hairs of 40 points in 0.16 s of CPU, this in 0.51 s (one run, by turns), of the 3.0 s
/// that `tuft brush goat-medium --picture` takes. Cairo blends encoded 8-bit colours, in which thin dark hair on white
/// comes out too dark. It has no line of changing width. It brings 20 libraries.
namespace tuft::render {

/// Picture of a brush in work.
struct BrushCanvas {
    int width = 0, height = 0;
    std::vector<float> rgb;  ///< linear, [height * width * 3], row 0 on top

    BrushCanvas(int w, int h, const Vec3& background);
};

/// Linear colour of an sRGB triple 0–255.
Vec3 linear_colour(int r, int g, int b);

/// Fills a polygon (even-odd) with exact horizontal and eightfold vertical coverage.
void fill_polygon(BrushCanvas& canvas, std::span<const Vec2> points, const Vec3& colour, double alpha = 1);

/// Draws a polyline with round joints. Widths are in pixels at each point; one value serves all points.
void stroke_line(BrushCanvas& canvas, std::span<const Vec2> points, std::span<const double> widths, const Vec3& colour,
                 double alpha = 1);

/// Digits, '.', '-', ',', space, small letters and N in strokes; `at` is the left end of the base line.
void write_text(BrushCanvas& canvas, std::string_view text, const Vec2& at, double size, const Vec3& colour);
double text_width(std::string_view text, double size);

/// To 8-bit sRGB.
std::vector<std::uint8_t> to_srgb(const BrushCanvas& canvas);

}  // namespace tuft::render
