#pragma once

#include <optional>
#include <vector>

#include "stroke/journal/entry/flat_area.h"

/// \file
/// Lines of a drawing as wide on the surface as they are drawn. Called by painting/apply_area.h.
namespace tuft::stroke {

/// Points of a flat drawing's rectangle on the surface, at the nodes of a grid.
struct SurfaceLattice {
    Vec2 low{0}, step{1};          ///< flat, metres: first node, distance of nodes
    int width = 0, height = 0;     ///< nodes
    std::vector<Vec3> at;          ///< metres, model frame, by rows from `low`. [width height]
    std::vector<char> on_surface;  ///< 0: past a border or cut off. [width height]

    /// Returns the point of the surface at flat coordinates, bilinear; nothing outside, and beside a node that is not
    /// on the surface.
    std::optional<Vec3> operator()(const Vec2& flat) const;
};

/// Returns the rings of an area, moved so that its lines have their drawn width on the surface x(p).
///
/// A geodesic map preserves lengths along lines through the drawing's origin. Across them it stretches where curvature
/// has spread them. With c the point of the area's lines nearest to a ring's point p, o = p − c, q = o turned by 90°
/// and G the metric of x, p becomes c + s d: d ⟂ G q, on the side of o, and the length of x(c) … x(c + s d) is |o|. So
/// the outline is offset from the line by the same distances as in the drawing, at right angles to the line on the
/// surface. Edges of rings are split into pieces no longer than a step of the lattice. Points beside a border remain.
///
/// Metrics are central differences over two steps of the lattice; widths are right to 1 % where the surface's radii of
/// curvature are above five steps. Cost: about 1 µs per point and 32 pieces of line.
std::vector<std::vector<Vec2>> even_rings(const FlatArea& area, const SurfaceLattice& lattice);

}  // namespace tuft::stroke
