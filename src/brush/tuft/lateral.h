#pragma once

#include <array>
#include <limits>
#include <vector>

/// Side nodes of the tuft: two to every spine node, which say how far the hair reaches to
/// either side. Stretch springs draw them to their spine node (water and hair that holds
/// together), bend springs run along each row of them (the hairs' own stiffness), and what
/// presses, bends or drags the tuft pushes them out. Their displacements u minimise
///
///   E = Σ w_i [½ κ u_i² - q_i u_i + ½ κ_w ⟨u_i - c_i⟩² + ½ κ0 r_i² (2 λ_i² v'² + λ_i⁴ v''²)_i],  v = u/r
///
/// for each side on its own. Slope and bend springs along the rows are at rest where the rows
/// keep the tuft's own taper r, so that a thin end goes on as flat as the hair before it and
/// closes to its point; λ_i = λ √(r_i/r_0), for water draws a thin end together over a shorter
/// way. In this proportion, with κ = κ0, their operator is κ (1 - λ² d²/dx²)² where r is even: a
/// push at one node is felt over some λ and nowhere drawn in. u = u' = 0 at the ferrule, both free
/// at the tip; a side node that meets a wall (c_i away) is pushed back by κ_w. Closed solve:
/// banded L D Lᵀ, repeated while the set of nodes at walls changes (at most kWallPasses).
/// Source: Chu and Tai 2002, 4.1.1 and 4.2.2 (lateral nodes, stretch and bend springs).
namespace tuft::brush {

inline constexpr int kWallPasses = 6, kDragPasses = 12;

struct LateralSprings {
    double stretch = 1e4;       ///< κ, N/m²: force per length of tuft per displacement
    double bend = 1e4;          ///< κ0 of the bend springs
    double reach = 2e-3;        ///< λ at the ferrule, m: how far along the tuft a push is felt where κ = κ0
    double wall = 100;          ///< κ_w over κ
    std::vector<double> taper;  ///< r > 0, [n+1], root first, any unit; or none: the same everywhere
};

/// One side's nodes, root first. [n+1] each.
struct LateralSide {
    std::vector<double> push;   ///< q, N/m, outward
    std::vector<double> clear;  ///< c, m, displacement at which a wall is met; infinite: none
    double root = 0;            ///< u_0, m: 0 in a ferrule; where a sub-spine leaves, what its trunk has
};

/// The springs of one row of side nodes, made once for all that is solved with them.
struct LateralRow {
    std::vector<std::array<double, 3>> band;  ///< of their matrix over v, lower half: [i][d] is the
                                              ///< element (i, i - d); that of the root holds it at 0
    std::vector<double> weight, taper;        ///< w_i, metres; r_i / r_0
    double wall = 0;                          ///< κ_w, N/m²
    std::array<double, 2> at_root{};          ///< elements (1, 0) and (2, 0) before the root was held
};
LateralRow lateral_row(const std::vector<double>& at, const LateralSprings& springs);

/// Displacements u, metres, outward, of the nodes at arc lengths `at` (metres from the ferrule,
/// strictly growing). [n+1]; u_0 = `side.root`.
std::vector<double> solve_lateral(const std::vector<double>& at, const LateralSprings& springs,
                                  const LateralSide& side);
std::vector<double> solve_lateral(const LateralRow& row, const LateralSide& side);

/// E and its gradient at displacements u, for tests. [n+1]; the gradient at the root is 0.
struct LateralEnergy {
    double value = 0;
    std::vector<double> gradient;
};
LateralEnergy lateral_energy(const std::vector<double>& at, const LateralSprings& springs, const LateralSide& side,
                             const std::vector<double>& u);

/// What the springs of one side store at the minimum u of E: E and the work of the push, joules;
/// Σ w_i [½ q_i u_i - ½ κ_w ⟨u_i - c_i⟩ c_i] there.
double stored_at_rest(const std::vector<double>& at, const LateralSprings& springs, const LateralSide& side,
                      const std::vector<double>& u);

/// Friction of the surface on the side nodes of both sides.
struct LateralFriction {
    std::vector<double> most;        ///< T >= 0, N/m on both sides together. [n+1]
    std::vector<double> stuck;       ///< d, m, displacement at which they would stick to the surface. [n+1]
    std::vector<signed char> slips;  ///< which are thought to slip, as in LateralShift; or none
};

/// Displacements δ, metres, by which both side nodes of each pair shift to the same side while the
/// surface drags them: they stick where the springs pull with less than T, and slip where not,
///
///   min S(δ) + Σ w_i T_i |δ_i - d_i|,
///
/// S what the springs of both sides store without walls. Slip loses w T |δ - d|, so that S grows by
/// no more than friction brings. Passes over the set of nodes that stick, at most kDragPasses, from
/// the set that is given.
struct LateralShift {
    std::vector<double> shift;       ///< δ. [n+1]
    double stored = 0;               ///< S, joules
    std::vector<signed char> slips;  ///< 0: sticks; else the sign of the force of the surface. [n+1] or none
};
LateralShift drag_lateral(const std::vector<double>& at, const LateralSprings& springs,
                          const LateralFriction& friction);
LateralShift drag_lateral(const LateralRow& row, const LateralFriction& friction);

/// Half-width r (1 + v): v = u/r with the outward part bent over to stay below `most` - 1, the
/// inward part to stay above -0.6: hair packs, and cannot pass through itself.
double half_width(double r, double u, double most);
/// The displacement u of a half-width: the inverse, as far as to 0.999 of the module that there is.
double side_of_width(double r, double width, double most);

}  // namespace tuft::brush
