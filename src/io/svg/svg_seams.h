#pragma once

#include <span>

#include "stroke/journal/entry/flat_area.h"

/// \file
/// Edges that areas of a drawing share. Called by svg_areas.cpp. Any thread.
namespace tuft::io {

/// Two areas share an edge where their outlines are nearer than this part of the drawing's larger side.
inline constexpr double kSharedEdge = 5e-4;

/// Depth of `FlatArea::under` from a shared edge, as a part of the drawing's larger side: at least two texels for a
/// drawing that is 100 texels large.
inline constexpr double kUnderDepth = 0.02;

/// Sets `FlatArea::under` of each area. With A an area, R the union of the later ones that cover what is below them and
/// share an edge with it, ε and D the lengths above, and ⊕ "grown by":
///
///     S = ((A − R) ⊕ ε) ∩ R − A,  under = (S ⊕ D) ∩ R − A
///
/// Where R goes on inside A, as the line round a shape does over both sides of its edge, there is no shared edge.
/// Areas of lines, pictures and areas that are translucent anywhere have nothing under them. `areas`: back to front, in
/// one frame. Areas with more points than `Shape` takes, and all of a drawing with more than
/// 16 million edges by cells of a grid or 200 million comparisons, stay as they are.
void set_under(std::span<stroke::FlatArea* const> areas);

}  // namespace tuft::io
