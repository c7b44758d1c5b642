#pragma once

#include <vector>

#include "core/geometry/types.h"

/// \file
/// Convex hull and smallest rectangle, for chart shapes in packing and merging.
namespace tuft::atlas {

/// Corners of the convex hull, counter-clockwise.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

/// The smallest rectangle around a convex polygon: (c, s) is the direction of its longer side.
struct Rectangle {
    double length = 0, width = 0;  ///< of its sides; length ≥ width
    double c = 1, s = 0;           ///< unit
};
Rectangle smallest_rectangle(const std::vector<Vec2>& hull);

}  // namespace tuft::atlas
