#pragma once

#include <optional>

#include "mesh/query/surface_query.h"

/// \file
/// A place on the surface that lies in a plane: of a model's symmetry, or level with another drawing. The studio's tool
/// for drawings and `tuft paint --snap` call it.
namespace tuft::stroke {

/// The points x with (x − through) · normal = 0.
struct SnapPlane {
    Vec3 through{0};       ///< metres
    Vec3 normal{1, 0, 0};  ///< unit

    double distance(const Vec3& p) const { return glm::dot(p - through, normal); }
};

/// Returns the point of the surface in the plane near `p`, within `reach` metres of it; nothing where there is none.
/// `p` is moved to the plane and to the nearest surface in turn (von Neumann's alternating projections) until it lies
/// within 1e-6 m of both. That is exact where the surface crosses the plane, and converges by cos² of the angle between
/// them.
std::optional<mesh::SurfacePoint> surface_point_in_plane(const mesh::SurfaceQuery& surface, const Vec3& p,
                                                         const SnapPlane& plane, double reach);

}  // namespace tuft::stroke
