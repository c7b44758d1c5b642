#pragma once

#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// \file
/// The surface as a steady hand takes it that goes along a path: normals and heights without what is
/// narrow. Used by `hold`.
namespace tuft::stroke {

/// Under one sample.
struct LevelledSurface {
    Vec3 normal{0, 0, 1};  ///< unit, out of the surface
    double height = 0;     ///< metres above the sample, along `normal`
};

/// Levels the surface under each of `samples` over `radius` (metres) of path to both sides.
///
/// With s the path length (`along`, from `travelled`; one for each sample, never falling) and n(s)
/// the samples' normals, linear in s between them, the normal is
///
///     ∫ w n ds / |∫ w n ds|   over [s − r, s + r],   r = min(radius, s, length − s),
///
/// where w = 1 at first and then 1 − (angle to the last mean / 0.5 rad)² ≥ 0, twice, so that the wall
/// of a groove hardly counts. The interval is symmetric, so that ends do not pull. The height is that
/// of a line fitted to `level_at` at stations every radius / 16 of path, within radius / 4, the
/// nearest counting most. Both depend on the path alone: not on where the samples lie on it, how many
/// they are, nor how long the hand rests. `radius` 0 leaves normals and heights as they are.
/// Cost: some 5 µs a sample, and 50 µs a station.
std::vector<LevelledSurface> level_surface(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                           std::span<const double> along, double radius);

}  // namespace tuft::stroke
