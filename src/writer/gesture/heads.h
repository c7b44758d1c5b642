#pragma once

#include "writer/glyphs/glyph.h"

/// \file
/// Heads of centre lines that do not show how the brush is set down. Called by the writer before sides are predicted.
namespace tuft::writer {

/// Returns a Han character whose centre lines begin as those of the typeface that sides are predicted from. Lines of a
/// pen (KanjiVG) and drawn ones have a short cue of the head or none, for which the table predicts balls.
///
/// A stroke of which a segment S, P or T of 120 units or more is the first, or follows a cue of less than 60 units,
/// begins beside its axis, as far along it as before, and joins it on a quadratic curve: control points a to the left
/// of the direction, on the axis 0.62 b on, and on the axis 1.9 b on. A corner there would be drawn as two lumps. With
/// L the length of the segment, units, a is the median over heads of hanzi-writer-data, about 3,200 S, 1,300 P and 280
/// T; b is the length after which these are within 4 units of their axis (of P 25, which is too tight for a tuft):
///
/// |                     | a                     | b       |
/// |---------------------|-----------------------|---------|
/// | S                   | −min(20 + 0.038 L, 43) | 35      |
/// | P                   | −min(28 + 0.04 L, 48)  | 30      |
/// | T below 52° / above | 31 / −40              | 40 / 49 |
///
/// A fifth less aside where another line is nearer than 50 units. A head that is 0.8 times as far aside stays, and so
/// does one that begins within 24 units of another line. Glyphs of other scripts, of fonts, and those that state an
/// outline are returned as they are.
Glyph with_heads(Glyph glyph);

}  // namespace tuft::writer
