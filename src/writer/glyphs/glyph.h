#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"
#include "core/text/text.h"

/// \file
/// Characters as strokes in the order in which a hand writes them. Readers of glyph_source.h make them;
/// `writer/gesture` turns them into motions of a brush. Frame: units of 1/1024 of the character's side, x to the right,
/// y up; the square of the character is [0, 1024]².
namespace tuft::writer {

inline constexpr double kSide = 1024;  ///< units along the side of a character's square

using Ring = std::vector<Vec2>;  ///< units; closed: the last point is joined to the first

/// One stroke of a character.
struct GlyphStroke {
    std::vector<Vec2> median;   ///< units, centre line from pen down to pen up, at least two points
    std::vector<Ring> outline;  ///< units, area of its ink (nonzero rule); empty: the source states none
    std::string type;           ///< stroke class of the source, such as kvg:type; empty: not stated
};

/// One character.
struct Glyph {
    char32_t code = 0;
    std::vector<GlyphStroke> strokes;  ///< in the order of writing
    std::vector<Ring> area;            ///< units, filled outline of a font without strokes (nonzero rule)
    double advance = kSide;            ///< units from its origin to that of the next character on a line
    double down = kSide;               ///< units from its top to that of the next character in a column
    double after = 0;                  ///< units of space after these, as between Han characters and Latin letters
    bool sideways = false;             ///< turned clockwise by a quarter, to stand in a column
    bool single_line = false;          ///< of a single-line font: an even pen line, without classes
    bool of_pen = false;  ///< centre lines of a pen, as in KanjiVG: their corners and hooks tell nothing of a width
};

/// Replaces every point p of a glyph by `to`(p).
template <class F>
void map_points(Glyph& glyph, const F& to) {
    const auto all = [&](std::vector<Vec2>& points) {
        for (Vec2& p : points) p = to(p);
    };
    for (Ring& ring : glyph.area) all(ring);
    for (GlyphStroke& s : glyph.strokes) {
        all(s.median);
        for (Ring& ring : s.outline) all(ring);
    }
}

/// Returns a point of a glyph that leans to the right of its reader by `slant` radians, units.
Vec2 leaned(const Vec2& p, const Glyph& glyph, double slant);

/// Returns the characters of a UTF-8 text; ill-formed bytes are read as ISO 8859-1. Throws `Error` for a text of more
/// than `kMostCharacters`.
std::u32string characters_of(std::string_view text);
inline constexpr std::size_t kMostCharacters = 10'000;

/// Returns whether a character is of the script Han [UAX24], but for U+3007 〇, which is a circle.
bool is_han(char32_t code);

/// Throws `Error` with `source` where a glyph has numbers that are not finite or beyond ±`kFarthestUnit`, a centre line
/// of fewer than two points, or more than `kMostStrokes` strokes or `kMostPoints` points.
void check_glyph(const Glyph& glyph, const std::string& source);
inline constexpr double kFarthestUnit = 16 * kSide;
inline constexpr std::size_t kMostStrokes = 256, kMostPoints = 100'000;

}  // namespace tuft::writer
