#pragma once

#include <optional>
#include <span>
#include <vector>

#include "brush/state/tuft_state.h"
#include "mesh/query/surface_query.h"

/// \file
/// Contact plane of a point, on the side of the surface where the ferrule is. Called by contact.h for every node,
/// and by `stroke` and `cli` to test poses.
namespace tuft::contact {

/// Position of a point relative to the surface.
struct Stand {
    brush::ContactPlane plane;       ///< touches the surface at `plane.origin`
    brush::ContactPlane met;         ///< the same, but with both faces' planes next to a sharp convex edge
    std::uint32_t triangle = kNone;  ///< under plane.origin; kNone: nothing within reach
    double height = 0;               ///< metres of the point over the plane, negative behind it
    Vec3 outside{0};                 ///< the point, or its projection in front of the surface
    double side = 1;                 ///< -1 where an open sheet is met from its back
};

struct StandOptions {
    double reach = 0.05;  ///< metres within which surfaces are looked for
    double lift = 2e-5;   ///< metres, distance of `outside` from the surface
};

/// Returns the surface that `p` meets when it comes from `from`, a point outside. If a wall of any thickness lies
/// between them, `p` is behind it, and the plane is that of the wall's front closest to p. Otherwise it is that of
/// the closest point. Over a convex edge the normal turns smoothly from one face to the other. `known`, if given,
/// is any point of the surface; it bounds the search and makes it faster.
Stand stand_from(const mesh::SurfaceQuery& surface, const Vec3& from, double side, const Vec3& p,
                 const StandOptions& options, const Vec3* known = nullptr);

/// Returns the stands of a chain of points (tip first, root last, like the tuft's nodes). Each is found from the
/// previous one, from the root outwards. Points farther than `near` from any surface share the last plane found;
/// their height over it is at most their distance from the surface. `before`, if not empty, holds the previous
/// stands of the same points and only makes the search faster.
std::vector<Stand> stand_along(const mesh::SurfaceQuery& surface, const Stand& root, std::span<const Vec3> points,
                               double near, const StandOptions& options, std::span<const Stand> before = {});

/// Returns a point outside the object for a tuft at `root` whose handle points along `up`. It is the root, or,
/// inside a closed object, the exit point of the handle.
Vec3 find_outside(const mesh::SurfaceQuery& surface, const Vec3& root, const Vec3& up, const StandOptions& options);

/// Returns the distance, metres, from a point inside a closed body to its surface. Returns 0 outside, and on both
/// sides of an open sheet. A point is inside when the first hits in all six axis directions are back faces. Cost:
/// six rays.
double depth_inside(const mesh::SurfaceQuery& surface, const Vec3& p);

}  // namespace tuft::contact
