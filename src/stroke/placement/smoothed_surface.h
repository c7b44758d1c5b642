#pragma once

#include <array>

#include "mesh/query/surface_query.h"

/// \file
/// The surface without detail narrower than a given radius. Called by draping and by levelling.
namespace tuft::stroke {

/// The smoothed surface near a point: the paraboloid z = (k₀ a² + 2 k₁ a b + k₂ b²) / 2 over the tangent plane, metres,
/// world frame, with a along `heading`, b along normal × heading and k the curvatures.
struct SurfacePatch {
    Vec3 position{0};
    Vec3 normal{0, 0, 1};                      ///< unit
    Vec3 heading{1, 0, 0};                     ///< unit, in the tangent plane
    std::array<double, 3> curvature{0, 0, 0};  ///< k, 1/m: along, mixed, across
    double fit_error = 0;                      ///< median distance of the surface from the paraboloid, metres
    bool found = false;                        ///< the surface was hit where a patch needs it
};

/// Fits a patch to the surface within `radius` (metres) of a guess, at 37 points of a hexagonal pattern hit by rays
/// along the guess's normal. Minimises the sum of pseudo-Huber distances; points below the patch count `below` times.
/// With too few hits the guess's curvature is retained, with hardly any the guess.
SurfacePatch fit_patch(const mesh::SurfaceQuery& query, const SurfacePatch& guess, double radius, double below = 1);

/// Returns the height of the smoothed surface over a point of the surface, metres along `normal` (unit): 0 on smooth
/// surface, the depth in a groove narrower than half of `radius`. The patch is fitted within `radius`. Where it fits
/// badly (median distance from 0.5 % of `radius`, weight 1, to 2 %, weight 0) and a disk half as wide fits better, a
/// half and then a quarter of `radius` are used: ridges are followed, shut lines and noise of a scan are not. Points
/// below the patch count one third: a hand rests on what is high.
double level_at(const mesh::SurfaceQuery& query, const Vec3& position, const Vec3& normal, double radius);

/// Returns the distance from `p` along `normal` to the next surface, at most `most`; metres.
double clearance(const mesh::SurfaceQuery& query, const Vec3& p, const Vec3& normal, double most);

}  // namespace tuft::stroke
