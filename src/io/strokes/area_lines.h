#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "io/strokes/shape.h"
#include "stroke/journal/trace.h"

/// Areas of a drawing as lines of a brush, the way a painter fills a shape: along its outline,
/// inside it.
namespace tuft::io {

/// A line and how wide it is to be drawn; metres.
struct AreaLine {
    std::vector<Vec2> line;
    double width = 0;
    /// Lengths at its ends over which the width falls to nothing: into a point of the area.
    double head = 0, tail = 0;
    std::vector<stroke::StencilEdge> stencil;  ///< of the outline, within three widths of the line
};

/// Lines that cover the shape within `rings`, the inner ones first.
/// With w = 0.36 · 2 area / perimeter, about a third of a stem's width, at least 6 % of the root of
/// the area, the curves at distances (0.22 + 0.33 k) w from the outline are drawn w wide and
/// overlap. They reach past the outline by 28 % of w and so into square corners, as a painter's do
/// who has it masked: `stencil edge` keeps them within. The outline they follow has the shape's bends to
/// 0.02 w, the stencil edge all of them. Where a curve turns by more than some 100 degrees it is parted,
/// and the parts of the outermost run on through the corner of the area and w/2 past it, as thin as
/// that. Where the outline stays bare by more than w (stems narrower than the line), half the width
/// is tried there, three times at most.
///
/// Empty for what has no area, more points than `Shape` takes, or more than `kMostEdges` edges at
/// that width.
std::vector<AreaLine> area_lines(std::span<const Ring> rings, FillRule rule);

inline constexpr std::size_t kMostEdges = 20'000;

}  // namespace tuft::io
