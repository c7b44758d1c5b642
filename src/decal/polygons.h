#pragma once

#include <vector>

#include "core/geometry/types.h"

/// \file
/// Plane regions bounded by rings: unions, offsets and distances, for cut lines (Clipper inside). Points are rounded to
/// 0.1 µm.
namespace tuft::decal {

/// A closed polygon without its first point repeated, metres.
using Ring = std::vector<Vec2>;

/// A region: outer rings counter-clockwise, holes clockwise. Points inside have a winding number above 0.
using Region = std::vector<Ring>;

/// Returns the signed area, m², positive counter-clockwise.
double area_of(const Ring& ring);
double area_of(const Region& region);

/// Return union, intersection and difference of two regions.
Region unite(const Region& a, const Region& b);
Region intersect(const Region& a, const Region& b);
Region subtract(const Region& a, const Region& b);
/// Returns the points within `distance` of the region, or for a negative one those that far inside. Round corners,
/// within 5 µm outwards and 10 µm inwards.
Region offset(const Region& region, double distance);
/// Returns the points within `distance` of an open line, without its round ends.
Region sweep(const std::vector<Vec2>& line, double distance);
/// Returns the region with points left out that lie within `tolerance` of the line between their neighbours.
Region simplify(const Region& region, double tolerance);

/// Returns whether a point lies in the region (winding number).
bool contains(const Region& region, const Vec2& p);

/// Returns each outer ring with its holes, the largest first.
std::vector<Region> separate(const Region& region);

/// Returns corners of the smallest box along the axes: lower left, upper right.
struct Box2 {
    Vec2 lo{0}, hi{0};
    Vec2 size() const { return hi - lo; }
};
Box2 box_of(const Region& region);

}  // namespace tuft::decal
