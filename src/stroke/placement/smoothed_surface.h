#pragma once

#include <array>

#include "mesh/query/surface_query.h"

/// The ground as a hand feels it that lies on it or is held over it: the surface without what is narrow.
namespace tuft::stroke {

/// The ground under a small disk: z = c[0] + c[1] a + c[2] b + (c[3] a² + 2 c[4] a b + c[5] b²) / 2
/// over its plane, metres, a along `heading`, b along normal × heading.
struct BaseColour {
    Vec3 position{0};
    Vec3 normal{0, 0, 1};
    Vec3 heading{1, 0, 0};
    std::array<double, 3> curvature{0, 0, 0};  ///< 1/m: along, mixed, across
    double fit_error = 0;                      ///< metres: median distance of the surface from it
    bool found = false;
};

/// The ground near where it is thought to be: a paraboloid fitted to the surface within `radius` (rays along the
/// guess's normal onto a hexagonal pattern of 37 points, least sum of pseudo-Huber distances). Where too little
/// of it is there for a curvature, that of the guess stays; where there is next to none, the guess itself. What lies
/// below the fit counts `below` as much as what lies above.
BaseColour feel(const mesh::SurfaceQuery& query, const BaseColour& guess, double radius, double below = 1);

/// Metres from a point of the surface up along `normal` (unit) to the ground there: 0 on what is smooth, the depth
/// of the groove in one that is narrower than half of `radius`. The ground is felt within `radius`; where the surface
/// does not fit (median distance 0.5 % of `radius` to 2 %, the more the less it counts) and a disk half as wide fits
/// better by itself, within a half of it, and then a quarter: a hand follows the ridge of a nose, passes over a shut
/// line, and does not tremble on the noise of a scan. It rests on what is high: what lies below counts a third.
double level_at(const mesh::SurfaceQuery& query, const Vec3& position, const Vec3& normal, double radius);

/// Room above a point before the surface on the other side comes, at most `most`; metres.
double clearance(const mesh::SurfaceQuery& query, const Vec3& p, const Vec3& normal, double most);

}  // namespace tuft::stroke
