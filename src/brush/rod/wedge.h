#pragma once

#include "core/geometry/types.h"

/// \file
/// Distance from a surface of two planes with its edge or corner rounded. Used by the rod's contact and by
/// `height_over`.
namespace tuft::brush {

/// Distance of a point from the surface, negative inside, and its derivatives. Any unit of length.
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

/// Returns the distance from a convex edge rounded by ρ: the distance from both planes moved in by ρ, less ρ. Over
/// a face this is the distance from its plane. In front of the edge it is the distance from a line, and its
/// gradient turns from one normal to the other. ρ is `rounding`. It is smaller at sharp edges, so that the rounding
/// removes at most 0.41 ρ, as at an edge of 90°.
Distance edge_distance(const Wedge& wedge, double rounding, const Vec3& x);

/// Returns the distance from a concave corner: the smaller of both distances. Where they differ by less than
/// `rounding` it is rounded, by at most a quarter of `rounding`.
Distance corner_distance(const Wedge& wedge, double rounding, const Vec3& x);

}  // namespace tuft::brush
