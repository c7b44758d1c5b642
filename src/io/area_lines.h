#pragma once

#include <span>
#include <vector>

#include "core/types.h"
#include "stroke/journal/trace.h"

/// Areas of a drawing as lines of a brush, the way a painter fills a shape: along its outline, inside it.
namespace tuft::io {

/// A line and how wide it is to be drawn; metres.
struct AreaLine {
    std::vector<Vec2> line;
    double width = 0;
    double head = 0, tail = 0;  ///< lengths at its ends over which the width falls to nothing: into a point of the area
    std::vector<stroke::TapeEdge> tape;  ///< of the outline, what lies within three widths of the line
};

enum class FillRule { nonzero, even_odd };  ///< SVG 1.1, 11.3

/// Lines that cover the area within the closed `rings` (metres; the last point joins the first), the inner ones first.
/// With w = 0.36 · 2 area / perimeter, about a third of a stem's width, at least 6 % of the root of the area, the
/// curves at distances (0.3 + 0.33 k) w from the outline are drawn w wide and overlap. They reach past the outline by 20 % of w
/// and so into square corners, as a painter's do who has it taped: `tape` keeps them within.
/// A curve at a distance d is what lies d away from the nearest edge of the edges' offsets by d, pieces joined where
/// they meet. Where it turns by more than some 100 degrees it is parted, and the parts of the outermost run on
/// through the corner of the area and w/2 past it, as thin as that. Where the outline stays bare by more than w (stems
/// narrower than the line), half the width is tried there, three times at most.
///
/// Empty for what has no area, or more than `kMostEdges` edges at that width.
std::vector<AreaLine> area_lines(std::span<const std::vector<Vec2>> rings, FillRule rule);

inline constexpr std::size_t kMostEdges = 20'000;

}  // namespace tuft::io
