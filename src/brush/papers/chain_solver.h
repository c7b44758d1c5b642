#pragma once

#include <span>
#include <vector>

#include "brush/rod/profile.h"
#include "brush/state/tuft_state.h"
#include "core/geometry/types.h"

/// \file
/// One kinematic chain in frictional contact, by sequential quadratic programming: the solver of the model `chain`
/// (chain.h). In units of the length L and the root stiffness B0, as the rod's (rod.h). Arrays go from root to tip.
///
/// State. Joint j turns segment j against the one inside by the rotation vector w_j, normal to the segment inside:
/// |w_j| is the bend-angle, its direction the turn-angle of Chu and Tai. The chain has no twist and no pole at w = 0
/// [X: they and Van Laerhoven use angle charts that have].
///
/// `solve_chain` minimises, over all w,
///
///     E = Σ κ_j (|w_j − ρ_j|^m + c |w_j − w'_j|^m) + Σ μN_i (1 − η_i) 2 (κ_f h(d∥) + (1 − κ_f) h(d⊥))
///
/// subject to z_i >= r_i at every node and p·(x_n − x'_n) <= l_p at the tip. w' is the last step's w; ρ its plastic
/// part; d_i the motion of node i over the surface since it touched; h(d) = √(d² + ε²) − ε [X: ‖d‖ has a kink at 0];
/// ∥ is along the projected tip; η = C max(0, d_p·d)^4 with d_p the direction of a tip dragged last. The factor 2 makes
/// κ_f = ½ isotropic with μ [X].
///
/// Sources: [Chu2002], 4.2.2–4.2.4; [VanLaerhoven2007], equations (2)–(4).
namespace tuft::brush {

/// Segments and joints of a spine. Lengths are in units of its length L.
struct ChainSpine {
    std::vector<double> length;       ///< [n] of the segments, sum 1
    std::vector<double> coefficient;  ///< [n] κ_j of the joints
    double exponent = 3;              ///< m >= 2
};

/// Returns the chain with B(s) |k/k_ref|^{m−2} k as the moment at curvature k: κ_j = I_j^{1−m} / m with
/// I_j = ∫ (B k_ref^{2−m})^{−1/(m−1)} ds over half a segment to each side of the joint. κ_j l^{m−1} is then the
/// same for any refinement. k_ref = π/2, the mean curvature of hair bent from upright to flat [X]; for m = 2 this is
/// the rod's joint.
ChainSpine make_chain_spine(const Profile& profile, std::span<const double> lengths, double exponent);

/// What one node meets. Friction acts where `normal_force` > 0.
struct ChainContact {
    ContactPlane plane;       ///< in units of L
    double radius = 0;        ///< r, least height
    double normal_force = 0;  ///< N of the last step
    Vec3 touched{0};          ///< where the motion d begins
    Vec3 normal{0, 0, 1};     ///< of the surface there; d is normal to it
};

/// Friction of the surface.
struct ChainFriction {
    double coefficient = 0;  ///< μ
    double grain = 0.5;      ///< κ_f
    double with_hair = 0;    ///< C_η
    Vec3 along{0};           ///< unit, the tip segment projected onto the surface; zero: isotropic
    double smoothing = 0;    ///< ε
};

/// The moving blocking plane of the pores.
struct ChainPore {
    bool active = false;
    Vec3 direction{1, 0, 0};  ///< p, unit
    Vec3 tip{0};              ///< x'_n
    double reach = 0;         ///< l_p
};

/// One solve: the spine at rest, its state before, the planes that it meets.
struct ChainProblem {
    Vec3 root{0};
    Mat3 frame{1};                          ///< at the root; its third column is the ferrule's axis
    std::span<const Vec2> rest;             ///< [n] ρ
    std::span<const Vec2> before;           ///< [n] w'
    double change_weight = 0;               ///< c
    std::span<const ChainContact> contact;  ///< [n] of nodes 1 … n; or empty
    ChainFriction friction;
    ChainPore pore;
    double edge_rounding = 0;  ///< of the planes at edges, in units of L
    int max_iterations = 60;
};

/// Result of one solve.
struct ChainSolution {
    std::vector<Vec2> bend;        ///< [n] w
    std::vector<Vec3> node;        ///< [n+1]
    std::vector<double> pressure;  ///< [n+1] multiplier of z >= r: the normal force
    std::vector<Vec3> force;       ///< [n+1] of the surface: normal force, friction, pores
    double bend_energy = 0;        ///< Σ κ_j |w_j − ρ_j|^m
    double dissipation = 0;        ///< the other terms of E
    int iterations = 0;
    bool converged = false;
};

/// Returns the nodes of a chain with bends w. [n+1]
std::vector<Vec3> chain_nodes(const ChainSpine& spine, const Vec3& root, const Mat3& frame, std::span<const Vec2> bend);

/// Solves from `start`. Method: SQP with the Hessian of the Lagrangian, shifted until it is positive definite; the
/// quadratic programme by its dual with active sets; ℓ1 merit function. Where constraints contradict each other (a
/// root below the surface) they give way by about 1e-9 of the force. Never throws; `converged` is false when it
/// stopped early. Cost: 0.1 ms per iteration at n = 16.
ChainSolution solve_chain(const ChainSpine& spine, std::span<const Vec2> start, const ChainProblem& problem);

}  // namespace tuft::brush
