#pragma once

#include <array>
#include <optional>
#include <span>

#include "brush/papers/space/half_space.h"
#include "core/geometry/types.h"

/// \file
/// Cubic B-splines of four control points (knots 0, 0, 0, 0, 1, 1, 1, 1) of a hair macro, and their least-squares
/// fits. t is 0 at the tip and 1 at the root. Source: [Xu2009], 5.3.1 and 5.4.3 (four control points)
/// [p]; the fit is named there, (5.3f) and Fig. 5.7, but not printed [R].
namespace tuft::brush::macro {

using Spline = std::array<double, 4>;
using CurveSpline = std::array<Vec3, 4>;  ///< metres

/// Return the value of a spline at t, 0–1 from the ferrule to the tip.
double value(const Spline& spline, double t);
Vec3 value(const CurveSpline& spline, double t);

/// Returns the curvature |K' × K''| / |K'|³, 1/m; 0 where the curve stands still.
double curvature(const CurveSpline& spline, double t);

/// How a spline of numbers is fitted. All arrays go from tip to root.
struct ValueFit {
    std::span<const double> t;
    std::span<const double> weight;
    std::span<const double> target;
    std::span<const double> lower = {};  ///< one bound per value, or none
    std::optional<double> root = {};     ///< value at the root, if it is held
    bool falling = false;                ///< the control points do not rise from tip to root, so neither do values
};

/// Returns the spline nearest to the values: min Σ w_i (y(t_i) − target_i)² with y(t_i) ≥ lower_i, and y(1) = root.
/// Cost: some microseconds.
Spline fit_spline(const ValueFit& fit);

/// How a skeleton is fitted to nodes. All arrays go from tip to root.
struct CurveFit {
    std::span<const double> t;
    std::span<const double> weight;
    std::span<const Vec3> nodes;       ///< metres
    std::span<const HalfSpace> above;  ///< one per node, or none
    Vec3 root{0};                      ///< metres, the last control point
    Vec3 direction{0, 0, -1};          ///< unit, of the hair where it leaves the root
    double length = 1;                 ///< metres, of the hair: the unit of the solver
};

/// Returns the skeleton nearest to the nodes that starts at `root` along `direction` and has no node but the root below
/// its half space (5.3f). A skeleton that already is such a spline is returned unchanged, to rounding. The solver stops
/// with nodes at most 1e-12 lengths below. When the root itself is below, the half spaces are ignored.
CurveSpline fit_curve(const CurveFit& fit);

}  // namespace tuft::brush::macro
