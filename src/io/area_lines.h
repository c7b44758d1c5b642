#pragma once

#include <span>
#include <vector>

#include "core/types.h"

/// Areas of a drawing as lines of a brush, the way a painter fills a shape: along its outline, inside it.
namespace tuft::io {

/// A line and how wide it is to be drawn; metres.
struct AreaLine {
    std::vector<Vec2> line;
    double width = 0;
    double head = 0, tail = 0;  ///< lengths at its ends over which the width falls to nothing: into a point of the area
};

enum class FillRule { nonzero, even_odd };  ///< SVG 1.1, 11.3

/// Lines that cover the area within the closed `rings` (metres; the last point joins the first), the inner ones first.
/// With w = 0.36 · 2 area / perimeter, about a third of a stem's width, at least 6 % of the root of the area, the
/// curves at distances (0.475 + 0.425 k) w from the outline are drawn w wide: they reach past it by 2.5 % of w and overlap.
/// A curve at a distance d is what lies d away from the nearest edge of the edges' offsets by d, pieces joined where
/// they meet. Where it turns by more than some 100 degrees it is parted, and the parts of the outermost run on
/// into the corner of the area, as thin as that. Where the outline stays bare by more than w (stems
/// narrower than the line), half the width is tried there, three times at most.
///
/// Empty for what has no area, or more than `kMostEdges` edges at that width.
std::vector<AreaLine> area_lines(std::span<const std::vector<Vec2>> rings, FillRule rule);

inline constexpr std::size_t kMostEdges = 20'000;

}  // namespace tuft::io
