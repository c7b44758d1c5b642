#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// \file
/// Functions shared by the mappings of flat samples onto a model: wrap and project (surface_mapping.cpp), drape
/// (drape.cpp).
namespace tuft::stroke {

/// Axes of flat samples on the surface, orthonormal.
struct Axes {
    Vec3 right, down;
};
/// Returns right and down orthonormal and orthogonal to `normal`; right retains its heading.
Axes axes_across(const Vec3& normal, const Vec3& right, const Vec3& down);

/// Returns `direction` rotated into the plane of a unit normal, of unit length.
Vec3 into_plane(const Vec3& direction, const Vec3& normal);

/// Returns the first hit of a ray at a distance in [0, t_max], metres. The point is the intersection with the
/// triangle's plane in double precision; Embree's is single.
std::optional<mesh::SurfacePoint> exact_ray(const mesh::SurfaceQuery& query, const Vec3& origin, const Vec3& direction,
                                            double t_max);

/// Returns a surface sample with the time, pressure and tilt of a flat one.
SurfaceSample hand_data(const StrokeSample& sample);

/// `SurfaceMapping::drape` of `map_to_surface`. `shared` is used where it is of this surface. `over`, where given,
/// becomes the samples' points on the smoothed surface, metres: they do not dip into grooves.
SurfaceTrace map_draped(const mesh::SurfaceQuery& query, const StrokeSamples& trace, Drapes* shared = nullptr,
                        std::vector<Vec3>* over = nullptr);

}  // namespace tuft::stroke
