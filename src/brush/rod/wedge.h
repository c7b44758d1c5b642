#pragma once

#include "core/geometry/types.h"

/// Distance from a surface that two planes make.
namespace tuft::brush {

/// Distance of a point from the surface, negative inside, with derivatives. Any unit of length.
struct Distance {
    double z = 0;
    Vec3 slope{0};    ///< ∂z/∂x
    double bend = 0;  ///< ∂²z/∂x² = bend · across acrossᵀ
    Vec3 across{0};
};

/// Two planes, each through `origin` with its unit normal out of the object.
struct Wedge {
    Vec3 origin[2]{Vec3{0}, Vec3{0}}, normal[2]{Vec3{0}, Vec3{0}};
};

/// Over a convex edge: the distance from both planes moved in by ρ, less ρ, so that the edge is
/// rounded by ρ. Over a face it is the face's plane; where the point is in front of the edge itself,
/// the distance from a line, whose slope turns with the point from one normal to the other. ρ is
/// `rounding`, or less where the edge is so sharp that more than 0.41 ρ would be taken off it, as
/// off an edge of 90°.
Distance edge_distance(const Wedge& wedge, double rounding, const Vec3& x);

/// In a concave corner: the smaller distance, rounded where they differ by less than `rounding`,
/// by a quarter of it.
Distance corner_distance(const Wedge& wedge, double rounding, const Vec3& x);

}  // namespace tuft::brush
