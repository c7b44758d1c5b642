#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "writer/copy/skeleton.h"

/// \file
/// Strokes of a copied character in the order of writing, from pieces of its skeleton: by rules, or by a list that
/// corrects them. Called for a copied character.
namespace tuft::writer {

/// A piece as a part of a stroke.
struct PieceUse {
    std::size_t piece = 0;
    bool reversed = false;  ///< written from its last point to its first

    bool operator==(const PieceUse&) const = default;
};

/// Strokes in the order of writing, each as pieces in order.
using StrokeOrder = std::vector<std::vector<PieceUse>>;

/// Returns strokes by rules.
///
/// At a junction the two pieces that turn least, below 45°, are one stroke. A run of such pieces is written from left
/// to right or from the top down; one that could be 提 or 撇 begins at its thicker end. At corners runs are one stroke
/// for 橫折, 橫撇, 豎折, 豎提, 撇折, 撇點, or where a short one is the hook of the other; a box is 豎, 橫折, 橫. Order:
/// parts of the character that a gap divides from left to right, else from the top down, each by these rules; a middle
/// stroke that is taller than both beside it first; within a part 橫 before what crosses it, 撇 before 捺, and what
/// begins higher. A bend within 1.5 half widths of a free end is the slanted head of its stroke.
StrokeOrder order_by_rules(const Skeleton& skeleton);

/// Reads an order, such as "1+2 -4 3": strokes by blanks or commas, pieces by "+", counted from 1, "-" for a piece that
/// is written the other way. Pieces that are not named are left out. Throws `Error` that quotes the word.
StrokeOrder parse_order(std::string_view text, std::size_t n_pieces);
std::string order_text(const StrokeOrder& order);

}  // namespace tuft::writer
