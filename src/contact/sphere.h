#pragma once

#include <span>

#include "core/geometry/types.h"

/// \file
/// Enclosing sphere of a point set by ball expansion. Called by near_vertices.h.
namespace tuft::contact {

/// Result of `expand_ball`, metres. r_expanded <= r* <= radius <= (1 + ε) r*, with r* the radius of the smallest
/// enclosing sphere.
struct Sphere {
    Vec3 centre{0};         ///< of the ball with `radius`
    double radius = 0;      ///< holds every point
    double r_start = 0;     ///< of the first ball, with diameter BC
    double r_expanded = 0;  ///< of the last ball, a lower bound of r*
    int iterations = 0;
    bool converged = true;  ///< false: stopped at `max_iterations`; radius still holds all points
};

/// First ball: B is the point farthest from points[0], C the one farthest from B; D0 = (B+C)/2,
/// r0 = |BC|/2. Then, for the point E farthest from D, l = |DE|,
///   r' = (r² + l²) / 2l,   D' = D + (l - r') (E - D)/l
/// until l <= (1 + ε) r; l is returned as the radius. Converges like 1/k: about 1/ε steps of
/// one pass over the points at worst, few for slender sets. An empty set gives a point.
/// Precondition: `epsilon` > 0, finite points. Source: [Huang2018], section 4; bound after [Badoiu2003].
Sphere expand_ball(std::span<const Vec3> points, double epsilon = 0.01, int max_iterations = 2000);

}  // namespace tuft::contact
