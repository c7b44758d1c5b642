#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// What the ways of laying flat samples onto a model share.
namespace tuft::stroke {

/// Right and down as an orthonormal pair across `normal`; right keeps its heading.
struct Axes {
    Vec3 right, down;
};
Axes axes_across(const Vec3& normal, const Vec3& right, const Vec3& down);

/// `direction` turned into the plane with the given unit normal, unit length.
Vec3 into_plane(const Vec3& direction, const Vec3& normal);

/// The first point of the surface that a ray meets at a distance in [0, t_max], where it meets
/// the plane of the triangle, in double.
std::optional<mesh::SurfacePoint> exact_ray(const mesh::SurfaceQuery& query, const Vec3& origin, const Vec3& direction,
                                            double t_max);

/// What a sample brings with it from the hand.
SurfaceSample hand_data(const TraceSample& sample);

/// `SurfaceMapping::drape`; see `lay`.
SurfaceTrace lay_draped(const mesh::SurfaceQuery& query, const Trace& trace);

}  // namespace tuft::stroke
