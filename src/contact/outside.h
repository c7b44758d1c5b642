#pragma once

#include <optional>
#include <span>
#include <vector>

#include "brush/tuft/tuft_state.h"
#include "mesh/query/surface_query.h"

/// Which surface a point of the tuft meets, seen from the side the ferrule is on.
namespace tuft::contact {

/// How a point stands to the surface.
struct Stand {
    brush::ContactPlane plane;       ///< touches the surface at `plane.origin`
    brush::ContactPlane met;         ///< the same; next to a sharp convex edge the planes of both
                                     ///< its faces instead
    std::uint32_t triangle = kNone;  ///< under plane.origin; kNone: nothing within reach
    double height = 0;               ///< metres of the point over the plane, negative behind it
    Vec3 outside{0};                 ///< the point itself, or where it comes out in front
    double side = 1;                 ///< -1 where an open sheet is met from its back
};

struct StandOptions {
    double reach = 0.05;  ///< metres within which surfaces are looked for
    double lift = 2e-5;   ///< metres that `outside` keeps off the surface
};

/// The surface that `p` meets, coming from `from`, a point known to be outside. If a wall lies
/// between them `p` is behind it, however thin it is, and the plane is that of the wall's
/// front next to p; otherwise it is that of the closest point. Over a convex edge the normal
/// turns smoothly from one face's to the other's. `known`, where given, is any point of the
/// surface: nothing farther is looked at, which makes it faster.
Stand stand_from(const mesh::SurfaceQuery& surface, const Vec3& from, double side, const Vec3& p,
                 const StandOptions& options, const Vec3* known = nullptr);

/// Follows a chain of points (tip first, root last, as the tuft's nodes) from the root
/// outwards, each from the one before. Points farther than `near` from any surface share the plane
/// of the last one looked up, which then is no closer to them than the surface. `before`, where
/// not empty, holds the stands of the same points a moment ago and only makes it faster.
std::vector<Stand> stand_along(const mesh::SurfaceQuery& surface, const Stand& root, std::span<const Vec3> points,
                               double near, const StandOptions& options, std::span<const Stand> before = {});

/// A start outside the object for a tuft at `root` whose handle points along `up`: the root
/// itself, or, when it is inside a closed object, where the handle comes out.
Vec3 find_outside(const mesh::SurfaceQuery& surface, const Vec3& root, const Vec3& up, const StandOptions& options);

/// Metres from a point within a closed body to its surface; 0 outside, and before or behind an open
/// sheet. Within: the surface is met from its back in all six directions of the axes. Cost: six
/// rays.
double depth_inside(const mesh::SurfaceQuery& surface, const Vec3& p);

}  // namespace tuft::contact
