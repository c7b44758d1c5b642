#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "io/strokes/shape.h"
#include "stroke/journal/recorded_stroke.h"

/// \file
/// Brush lines that fill an area of a drawing, parallel to its outline as a painter fills a shape. Called by svg.cpp.
/// Any thread.
namespace tuft::io {

/// One line of the filling; lengths in metres.
struct AreaLine {
    std::vector<Vec2> line;
    double width = 0;  ///< of the drawn line
    /// Lengths at the start and the end over which the width falls to 0, into a corner of the area.
    double taper_in = 0, taper_out = 0;
    std::vector<stroke::StencilEdge> stencil;  ///< of the outline, within three widths of the line
};

/// Returns lines that cover the area of `rings`, innermost first.
///
/// Width w = 0.36 · 2 area / perimeter, about a third of a stem's width, and at least 6 % of √area. Line k runs at the
/// distance (0.22 + 0.33 k) w from the outline and is drawn w wide, so neighbouring lines overlap. The outermost line
/// extends past the outline by 28 % of w, into square corners; its `stencil` keeps the ink inside, as a painter's mask
/// does. Lines follow the outline's bends to 0.02 w, the stencil follows all of them.
///
/// A line is split where it turns by more than about 100 degrees. The parts of the outermost one continue through the
/// corner of the area and w/2 beyond, tapered. Where a part of the outline stays bare by more than w, because a stem is
/// narrower than the line, it is filled with half the width; at most three times.
///
/// Returns nothing for rings without area, for more points than `Shape` takes and for more than `kMostEdges` edges.
std::vector<AreaLine> area_lines(std::span<const Ring> rings, FillRule rule);

inline constexpr std::size_t kMostEdges = 20'000;

}  // namespace tuft::io
