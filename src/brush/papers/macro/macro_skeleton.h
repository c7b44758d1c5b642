#pragma once

#include <span>
#include <vector>

#include "brush/papers/space/half_space.h"

/// \file
/// Deformation of the skeleton of a hair macro by the surface: projection, rotation and kink-up. Nodes go from tip
/// (t = 0) to root (t = 1), metres, world. Called by hair_macro.cpp.
///
/// Source: [Xu2009], 5.4.1.1. [p] is printed there, [R] is restored, [X] is ours.
///
///     K_n(t) = (1 − r) K_pro(t) + r K_ro(t)                                          (5.3a) [p]
///     K_pro: points below the surface, dropped onto it along its normal              (5.3b) [p]
///     t_p = max{t : K_o(t) below}                                                    (5.3c) [p]
///     K_ro: t < t_p turned about K_o(t_p) by φ_min, the rest as it was               (5.3d) [p]
///     φ_min: least turn after which no point is below, over a plane
///            max_t atan2(depth, run) of the points seen from K_o(t_p)                (5.3e) [R]
///
/// (5.3e) is garbled in print. The axis of the turn is not printed: it is n × K' at t_p; where the hair is upright
/// there, it is n × the direction against the hand's last motion [X]. Both parts are above the surface, so K_n is.
namespace tuft::brush::macro {

/// r and the direction of upright hair.
struct SkeletonLaw {
    double rigidity = 0.5;  ///< r of (5.3a), 0 projected … 1 rotated
    Vec3 aside{1, 0, 0};    ///< direction in which hair falls that is upright, world
    double upright = 0.02;  ///< sine of the angle to the normal below which hair is upright [X]
    /// [nodes] or none: the mean of all hair of the tuft, metres, world. A part falls as the whole does: that it leans
    /// away from the rest is no lean [X].
    std::span<const Vec3> trunk = {};
};

/// Skeleton after it met the surface.
struct BentSkeleton {
    std::vector<Vec3> nodes;  ///< K_n before the fit; no node is below its half space
    bool touching = false;    ///< some node of K_o was below
    double touch = 0;         ///< t_p, where the hair meets the surface
    Vec3 pivot{0};            ///< K_o(t_p)
    Vec3 along{0};            ///< unit, tangent to the surface, from the pivot towards the tip
    double turn = 0;          ///< φ_min, radians
};

/// Applies (5.3a) to (5.3e) to nodes with parameters `t`.
BentSkeleton deform_skeleton(std::span<const Vec3> nodes, std::span<const double> t, std::span<const HalfSpace> above,
                             const SkeletonLaw& law);

/// Half-angle α in [0, π] of the circular arc of length s over a chord c: sin α / α = c/s. `ratio` = c/s, clamped to
/// [0, 1].
double arc_half_angle(double ratio);

/// Bends up the part of the skeleton between pivot and tip. Squeezed onto a chord shorter than its own length, it
/// bulges off the surface as a circular arc. The text asks for the original arc length over the squeezed chord [p]; the
/// circle and the plane of chord and normal are [R]. `held` is the fraction of the squeeze that friction holds, 0 … 1
/// [X]: the arc has length c + held (s − c), with s the rest length `length` · t_p.
void add_kink(BentSkeleton& bent, std::span<const double> t, std::span<const HalfSpace> above, double length,
              double held);

}  // namespace tuft::brush::macro
