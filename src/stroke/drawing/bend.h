#pragma once

#include "stroke/journal/entry/flat_area.h"

/// \file
/// A flat drawing bent along a curve, for copies that follow a path on a model. Called by `tuft paint --along`.
namespace tuft::stroke {

/// Maps a point by the bend of geodesic curvature κ (1/m, positive towards −y) of the line y = 0 through the origin:
///
///     (x, y) → ((ρ + y) sin(x/ρ), (ρ + y) cos(x/ρ) − ρ),    ρ = 1/κ.
///
/// Lengths along y = 0 are preserved and lines x = const become its normals. So neighbours of width w whose middles lie
/// w apart on an arc of that curvature meet along a whole edge.
Vec2 bend_point(const Vec2& point, double curvature);

/// Bends samples, stencil and outline of a flat trace. Chords of outline and stencil are split, so that they are within
/// 0.1 % of `width` of the arcs, with `width` that of the drawing, metres.
void bend_samples(StrokeSamples& trace, double curvature, double width);
/// Bends all rings and lines of an area in the same manner; its bounds become those of the rings. Its gradient does not
/// bend.
void bend_area(FlatArea& area, double curvature, double width);

/// Moves the points of rings at x = ± `half` outwards by `lap`, metres. Neighbours that meet at a line share its texels
/// by parts; where they lap by a texel, no line shows.
void lap_ends(std::vector<std::vector<Vec2>>& rings, double half, double lap);

}  // namespace tuft::stroke
