#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "writer/copy/stroke_order.h"
#include "writer/glyphs/glyph.h"

/// \file
/// A character copied from its ink. Called by `tuft write --like`.
namespace tuft::writer {

/// Returns the character whose strokes are an order of pieces: centre lines, and the ink of each as its outline.
///
/// A centre line runs straight through junctions of its stroke; at a corner its arms are continued to where they meet.
/// A cell of ink belongs to the stroke whose centre line is nearest by d² − r², with r the half width there, and
/// besides to each that covers it where it runs through a junction. Preconditions: the order is one of the skeleton's
/// pieces. Cost: cells × points of the lines / 16.
Glyph copied_glyph(const Cells& ink, const Skeleton& skeleton, const StrokeOrder& order, char32_t code);

/// Returns a character of a font as strokes, as a brush would write it: its area is thinned, and each stroke, in the
/// order by rules, has its part of the area as its outline. Fonts are untrusted, and work and memory are bounded.
/// Unchanged: a character without an area, one more than `kWidestCopied` wide or high, one of more ink than its square
/// holds, one that thinning leaves more than 1024 lines of or that has more than `kMostStrokes` pieces, one of more
/// than 1e9 pairs of cells and points, and one in which no centre line is found. Cost: that of `copied_glyph`.
Glyph strokes_of_area(const Glyph& glyph);
inline constexpr double kWidestCopied = 4 * kSide;  ///< units

/// Colours of strokes that lie beside each other, in turn, sRGB as 0xrrggbb; told apart without red and green
/// [Okabe2008].
inline constexpr std::array<std::uint32_t, 6> kStrokeColours{0x0072b2, 0xd55e00, 0x009e73,
                                                             0xcc79a7, 0xe69f00, 0x56b4e9};

/// Returns a drawing of the ink with every piece, its number and its direction of writing; a colour for each stroke,
/// and below the order as `parse_order` reads it. SVG.
std::string numbered_svg(const Cells& ink, const Skeleton& skeleton, const StrokeOrder& order);

}  // namespace tuft::writer
