#pragma once

#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// \file
/// Normals and heights of the surface along a path, without narrow detail. Called by placement.h: a hand does not
/// follow grooves.
namespace tuft::stroke {

/// The levelled surface under one sample.
struct LevelledSurface {
    Vec3 normal{0, 0, 1};  ///< unit, out of the surface
    double height = 0;     ///< metres above the sample, along `normal`
};

/// Levels the surface under each of `samples` over `radius` (metres) of path to both sides. [samples]
///
/// With s the path length (`along`, from `travelled`, [samples], ascending) and n(s) the samples' normals, linear in s
/// between them, the normal is
///
///     ∫ w n ds / |∫ w n ds|   over [s − r, s + r],   r = min(radius, s, length − s),
///
/// with w = 1 at first and w = max(0, 1 − (angle to the last mean / 0.5 rad)²) in two more passes, so that walls of
/// grooves hardly count. The interval is symmetric: ends do not pull. The height is that of a line fitted to `level_at`
/// at stations every radius / 16 of path, within radius / 4, weighted by nearness. Normal and height depend on the path
/// alone, not on number and position of the samples, nor on rests. With `radius` 0 they are those of the surface. Cost:
/// 5 µs per sample, 50 µs per station.
std::vector<LevelledSurface> level_surface(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                           std::span<const double> along, double radius);

}  // namespace tuft::stroke
