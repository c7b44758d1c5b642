#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "writer/copy/photo.h"
#include "writer/copy/stroke_order.h"

/// \file
/// How a person corrects the copy of a picture: by options of `tuft write --like`, or by hand in the studio.
namespace tuft::writer {

/// All that a copy follows from, besides the picture.
struct CopyCorrection {
    double threshold = 0;        ///< of `picture_ink`
    std::vector<PieceCut> cuts;  ///< in order; each may name pieces that those before it made
    std::string order;           ///< `parse_order`, of the pieces after all cuts; empty: by rules

    bool operator==(const CopyCorrection&) const = default;
};

/// A picture taken apart into strokes.
struct CopiedPicture {
    PictureInk ink;
    Skeleton skeleton;  ///< after the cuts
    StrokeOrder order;
};

/// Takes a picture apart. Without an order, strokes are those by rules, in which the parts of a cut piece follow each
/// other in one stroke. Throws `Error` as `picture_ink`, `cut_piece` and `parse_order` do.
CopiedPicture take_apart(const io::Image8& picture, const std::string& source, const CopyCorrection& correction);

/// Reads cuts, such as "3:0.45 5:0.3": pieces counted from 1, and the part of the piece's length. Throws `Error` that
/// quotes the word. `cuts_text` writes three digits.
std::vector<PieceCut> parse_cuts(std::string_view text);
std::string cuts_text(const std::vector<PieceCut>& cuts);

/// Edits of an order. `stroke`, `other`: below its size.
void move_stroke(StrokeOrder& order, std::size_t stroke, std::size_t to);
void reverse_stroke(StrokeOrder& order, std::size_t stroke);
/// Writes `other` in one stroke with `stroke`, after it.
void join_strokes(StrokeOrder& order, std::size_t stroke, std::size_t other);
void remove_stroke(StrokeOrder& order, std::size_t stroke);

/// A place on a stroke.
struct StrokePlace {
    std::size_t stroke = 0;
    std::size_t use = 0;  ///< of the stroke's pieces
    double at = 0;        ///< part of the piece's length, from the piece's first point
    double distance = 0;  ///< units, from the point that was asked about
};
/// Returns the place of the strokes nearest to a point, units. Precondition: there is a stroke.
StrokePlace nearest_place(const CopiedPicture& copy, const Vec2& point);

/// Returns the correction that splits a stroke at a place: between two pieces where their joint is within
/// `kJointReach` units, else through a piece. Returns `before`, with its order stated, where the place is that near to
/// an end of the stroke.
CopyCorrection split_at(const CopiedPicture& copy, const CopyCorrection& before, const StrokePlace& place);
inline constexpr double kJointReach = 24;

}  // namespace tuft::writer
