#pragma once

#include <array>

#include "core/geometry/types.h"

/// \file
/// Closed-form logarithmic map between two points of a smooth surface with known positions and unit normals: no
/// path, no iteration, about 35 flops. Used by `footprint`.
namespace tuft::atlas {

/// Coefficients of x = 1 − c, lowest power first, of (1 + c) K(c) with
/// K(c) = (θ / sin θ − 1) / sin² θ, θ = acos c; within 2e-5 for c in [−0.36, 1].
inline constexpr std::array<double, 8> kLogMapSeries{0.33332254,   0.134294424, 0.0432825248, 0.10015319,
                                                     -0.180975939, 0.26225653,  -0.171078885, 0.0495550044};

/// The smallest dot product of two normals for which the map holds.
inline constexpr double kLogMapMinCos = -0.35;

/// Surface coordinates (u, v) of point `p` with unit normal `m`, in metres along
/// frame.t and frame.b as walked along the surface from frame.origin:
///   d = p − p0, c = m·n, a = K (m·d − c n·d),
///   g = (n·d − c m·d)/(1 + c) + m·d + K (n·d − c m·d),
///   (u, v) = (d·t, d·b) + ½ (a − g) (m·t, m·b), a − g = (1 + c) K (m·d − n·d) − (m·d + n·d)/(1 + c).
/// The mean of the curvature-corrected tangent projections from both ends. Exact
/// (to the series) on planes, spheres and circular cylinders, third-order exact on
/// any smooth surface; wrong across creases. Precondition: c > kLogMapMinCos.
Vec2 log_map(const Frame& frame, const Vec3& p, const Vec3& m);

/// Returns the direction of tangent vector `t` at normal `from`, rotated by the smallest rotation to frame.n, as
/// cosine and sine of its angle to frame.t.
Vec2 transport_direction(const Frame& frame, const Vec3& t, const Vec3& from);

}  // namespace tuft::atlas
