#pragma once

#include <array>
#include <limits>

#include "core/system/recycled.h"

/// \file
/// Side nodes of the tuft: two to every spine node. They give the lateral extent of the hair. Stretch springs pull
/// them to their spine node (surface tension and cohesion); bend springs run along each row (stiffness of the
/// hairs); contact force, bending and friction push them out. Called by tuft_sections.h.
///
/// Their displacements u minimise, for each side separately,
///
///     E = Σ w_i [½ κ u_i² − q_i u_i + ½ κ_w ⟨u_i − c_i⟩² + ½ κ0 r_i² (2 λ_i² v'² + λ_i⁴ v''²)_i],  v = u/r.
///
/// The slope and bend springs are at rest where the rows follow the tuft's taper r. A thin end is then as flat as
/// the hair before it and closes to its point. λ_i = λ √(r_i/r_0): surface tension acts over a shorter length on a
/// thin end. With κ = κ0 and even r the operator is κ (1 − λ² d²/dx²)²: a push at one node spreads over about λ and
/// never pulls inward. Boundary conditions: u = u' = 0 at the ferrule, free at the tip. A side node beyond its wall
/// at distance c_i is pushed back with stiffness κ_w. Solution: banded L D Lᵀ, repeated while the set of nodes at
/// walls changes, at most kWallPasses times. Source: [Chu2002], 4.1.1 and 4.2.2 (lateral nodes, stretch and
/// bend springs).
namespace tuft::brush {

inline constexpr int kWallPasses = 6, kDragPasses = 12;

/// Stiffness of the springs between spine and side nodes.
struct LateralSprings {
    double stretch = 1e4;    ///< κ, N/m²: force per length of tuft per displacement
    double bend = 1e4;       ///< κ0 of the bend springs
    double reach = 2e-3;     ///< λ at the ferrule, m: length over which a push spreads along the tuft where κ = κ0
    double wall = 100;       ///< κ_w over κ
    Recycled<double> taper;  ///< r > 0, [n+1], root first, any unit; empty: constant
};

/// One side's nodes, root first. [n+1] each.
struct LateralSide {
    Recycled<double> push;   ///< q, N/m, outward
    Recycled<double> clear;  ///< c, m, displacement at which the node meets a wall; infinite: none
    double root = 0;         ///< u_0, m: 0 in a ferrule; for a sub-spine, the displacement of its trunk there
};

/// Factorised springs of one row of side nodes, reusable for several loads.
struct LateralRow {
    /// Lower half of their matrix in v: [i][d] is element (i, i − d); the root's row fixes it at 0.
    Recycled<std::array<double, 3>> band;
    Recycled<double> weight, taper;   ///< w_i, metres; r_i / r_0
    double wall = 0;                  ///< κ_w, N/m²
    std::array<double, 2> at_root{};  ///< elements (1, 0) and (2, 0) before the root was fixed
};
LateralRow lateral_row(const Recycled<double>& at, const LateralSprings& springs);

/// Returns the outward displacements u, metres, of the nodes at arc lengths `at` (metres from the ferrule, strictly
/// increasing). [n+1]; u_0 = `side.root`.
Recycled<double> solve_lateral(const Recycled<double>& at, const LateralSprings& springs, const LateralSide& side);
Recycled<double> solve_lateral(const LateralRow& row, const LateralSide& side);

/// E and its gradient at displacements u, for tests. [n+1]; the gradient at the root is 0.
struct LateralEnergy {
    double value = 0;
    Recycled<double> gradient;
};
LateralEnergy lateral_energy(const Recycled<double>& at, const LateralSprings& springs, const LateralSide& side,
                             const Recycled<double>& u);

/// Returns the energy that the springs of one side store at the minimum u of E, joules: E and the work of the push,
/// Σ w_i [½ q_i u_i − ½ κ_w ⟨u_i − c_i⟩ c_i].
double stored_at_rest(const Recycled<double>& at, const LateralSprings& springs, const LateralSide& side,
                      const Recycled<double>& u);

/// Friction of the surface on the side nodes of both sides.
struct LateralFriction {
    Recycled<double> most;        ///< T >= 0, N/m on both sides together. [n+1]
    Recycled<double> stuck;       ///< d, m, displacement at which they stick to the surface. [n+1]
    Recycled<signed char> slips;  ///< initial guess of the slipping nodes, as in LateralShift; or empty
};

/// Returns the displacements δ, metres, of both side nodes of each pair to the same side under friction. A pair
/// sticks where the springs pull with less than T and slips otherwise:
///
///     min S(δ) + Σ w_i T_i |δ_i − d_i|,
///
/// with S the energy of the springs of both sides without walls. Slip dissipates w T |δ − d|, so S grows by at most
/// the work of friction. Method: passes over the set of sticking nodes, at most kDragPasses, from the given set.
struct LateralShift {
    Recycled<double> shift;       ///< δ. [n+1]
    double stored = 0;            ///< S, joules
    Recycled<signed char> slips;  ///< 0: sticks; else the sign of the force of the surface. [n+1] or none
};
LateralShift drag_lateral(const Recycled<double>& at, const LateralSprings& springs, const LateralFriction& friction);
LateralShift drag_lateral(const LateralRow& row, const LateralFriction& friction);

/// Returns the half-width r (1 + v), v = u/r. A smooth limiter holds the outward part below `most` − 1 and the
/// inward part above −0.6: packed hair cannot pass through itself.
double half_width(double r, double u, double most);
/// Returns the displacement u of a half-width: the inverse of `half_width`, up to 0.999 of the available range.
double side_of_width(double r, double width, double most);

}  // namespace tuft::brush
