#pragma once

#include <cstddef>
#include <vector>

#include "writer/gesture/cells.h"

/// \file
/// Centre lines of an area of ink, cut into pieces at ends, junctions and corners. Called for a copied character.
/// Units, y up.
namespace tuft::writer {

/// A centre line between two nodes.
struct Piece {
    std::vector<Vec2> line;             ///< from `nodes[from].at` to `nodes[to].at`, points about 2 apart
    std::size_t from = 0, to = 0;       ///< nodes
    double half_from = 0, half_to = 0;  ///< mean half width of the first and of the last third

    double length() const;
};

/// Where pieces end or meet.
struct SkeletonNode {
    Vec2 at{0};
    double room = 0;           ///< distance to the edge of the ink
    std::size_t n_pieces = 0;  ///< ends of pieces: 1 a free end, 2 a corner, more a junction
};

/// Centre lines of a character, in pieces that meet at nodes.
struct Skeleton {
    std::vector<Piece> pieces;
    std::vector<SkeletonNode> nodes;
};

/// Returns the centre lines of an area.
///
/// Thinned as [Guo1989] do. Spurs that a
/// disc about their junction nearly covers are no strokes: they end within 1.8 of its radius. Junctions closer than 1.2
/// of the larger radius are one. Pieces are cut at corners (`make_stroke_line`, over at
/// least 1.3 half widths). Free ends are continued straight to 12
/// units before the edge, as centre lines of typefaces end. A blob without a line has one along its longest direction.
/// Where thinning leaves more than `most` lines: nothing. What follows compares lines with each other.
/// Cost: cells, edge × half width, lines².
Skeleton skeleton_of(const Cells& ink, std::size_t most = static_cast<std::size_t>(-1));

/// A place where a person cuts a piece.
struct PieceCut {
    std::size_t piece = 0;
    double at = 0.5;  ///< part of the piece's length from its first point, 0–1

    bool operator==(const PieceCut&) const = default;
};

/// Cuts a piece: it keeps its first part, and the rest is a new piece, the last one. Lines keep their points. Throws
/// `Error` for a piece that there is not, and for a part that is not within 0 and 1.
void cut_piece(Skeleton& skeleton, const PieceCut& cut);

/// Distances to the edge of the ink, by places.
class InkClearance {
  public:
    explicit InkClearance(const Cells& ink) : ink_(ink), clearance_(clearances(ink)) {}
    double at(const Vec2& p) const;

  private:
    const Cells& ink_;
    std::vector<float> clearance_;
};

}  // namespace tuft::writer
