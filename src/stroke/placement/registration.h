#pragma once

#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/model_motion.h"

/// \file
/// Registration of two surfaces by iterated closest points [Besl1992], point to plane
/// [Chen1992], trimmed [Chetverikov2002]. Called by model_motion.h.
namespace tuft::stroke {

/// A point of a surface with its smooth unit normal; metres.
struct OrientedPoint {
    Vec3 position{0}, normal{0, 0, 1};
};

/// Returns `count` points distributed evenly over the area, the same at each call. Empty for a mesh without area.
std::vector<OrientedPoint> even_points(const mesh::TriangleMesh& mesh, std::size_t count);

/// Part of the points that must fit; the farther ones may lie on what was changed.
inline constexpr double kFittingPart = 0.7;

/// Mean distances of points to a surface, metres.
struct MeanDistance {
    double fitting = 0;  ///< of the `kFittingPart` of the points that are nearest
    double all = 0;
};

/// Returns the mean distances of the moved points to a surface. A distance counts at most `most`.
MeanDistance mean_distance(std::span<const OrientedPoint> points, const mesh::SurfaceQuery& surface,
                           const ModelMotion& motion, double most);

/// Limits of `register_points`.
struct RegistrationOptions {
    MotionFreedom freedom = MotionFreedom::similarity;
    double size = 0;      ///< metres, diagonal of the surface's box
    double slack = 0;     ///< metres within which a point counts, however far it is from the median
    int iterations = 80;  ///< at most
};

/// Improves a motion until it takes the points onto the surface: minimises Σ (n·(M p − c))² over the points, c the
/// closest point and n its normal. A point does not count where it is farther than `slack` and than five times the
/// median distance, because it lies on what was changed. Nor does a pair whose normals differ by more than 70°.
/// Directions in which the surface slides in itself, such as the turn of a bowl about its axis, do not change:
/// eigenvalues below 1e-4 of the largest. Ends where no point moves by more than 1e-7 of `size`, or after `iterations`.
/// Converges from rotations of about 30° where shapes agree. Deterministic.
ModelMotion register_points(std::span<const OrientedPoint> points, const mesh::SurfaceQuery& surface, ModelMotion start,
                            const RegistrationOptions& options);

}  // namespace tuft::stroke
