#pragma once

#include <Eigen/Dense>
#include <span>

#include "brush/rod/coupled/coupled_rods.h"
#include "brush/rod/rod_solver.h"
#include "core/system/recycled.h"

/// \file
/// Coupling energy of neighbouring rods and the Newton step of all rods together. Internal to the rod solver.
namespace tuft::brush::rod {

/// Directions of a pair of nodes and its friction, constant during one Newton minimisation.
struct FrozenNode {
    Vec3 tangent{0, 0, -1}, row{1, 0, 0}, across{0, 1, 0};  ///< t, r and m, unit
    double cap = 0;                                         ///< force per length at which the pair slides
    double faces = 1;                                       ///< f: 0 where they have slid past each other
};

/// Shift along the hair of two facing segments, u = ½ (t₁ + t₂)·d with d the distance of their outboard nodes: what
/// its spring adds to Π.
struct SegmentShear {
    double force = 0;       ///< ψ' times the length of the segment
    double stiffness = 0;   ///< ψ'' likewise
    Vec3 mean{0};           ///< ½ (t₁ + t₂) = ∂u/∂d
    Vec3 half_distance{0};  ///< ½ d = ∂u/∂t of both
};

/// A pair of neighbouring rods with what one pass holds constant. m segments couple them.
struct FrozenPair {
    const CoupledPair* pair = nullptr;
    int nodes = 0;              ///< m + 1
    Recycled<double> weight;    ///< [m+1] length of hair that a node stands for
    Recycled<FrozenNode> node;  ///< [m+1]
    Recycled<Sym3> curvature;   ///< [m+1] ∂²U/∂d² of the last evaluation, times the weight; without shear along t
    Recycled<double> normal;    ///< [m+1] k_n ⟨g₀ − g⟩ there
    Recycled<double> lagged;    ///< [m+1] the same of the pass before, or of the last solve: it bounds friction
    Recycled<SegmentShear> shear;  ///< [m] there, or empty

    int segments() const { return nodes - 1; }
};

/// All rods of one solve as a system of `minimise`.
class CoupledSystem {
  public:
    CoupledSystem(std::span<Solver> solvers, std::span<FrozenPair> pairs, const CouplingLaw& law)
        : solvers_(solvers), pairs_(pairs), law_(law) {}

    double tolerance() const { return solvers_.front().law.limits.tolerance; }
    double value() const { return value_; }
    std::span<const double> gradient() const { return gradient_; }
    std::span<const double> step() const { return step_; }
    void differentiate();
    void differentiate_twice();
    int newton_step(bool by_eigenvectors);
    double try_step(double scale);
    double probe_step(double scale);
    void complete_step();
    void accept();

    /// Freezes the directions and the friction of the pairs for nodes that lie as in `at`.
    void freeze_pairs();
    /// Evaluates Π at the shapes; with it the terms that `differentiate` reads.
    void evaluate_all();
    /// Returns Π alone at ws.next of all rods. Their ws.trial is undefined afterwards.
    double value_of_next();
    /// ∂Π/∂x of the nodes of rod k without the coupling, at the shapes. [n+1]
    Recycled<Vec3>& own_slope(std::size_t k) { return own_slope_[k]; }
    /// Solves (H + damping) u = −gradient; false where the matrix is not positive definite.
    bool descend(double damping);
    /// H, dense and symmetric, for tests.
    Eigen::MatrixXd dense() const;

  private:
    /// Moves ws.next of all rods to `scale` · step.
    void advance_all(double scale);
    /// Adds the coupling to evaluations of all rods and returns its energy. Without `derivatives` it changes nothing.
    double add_coupling(Evaluation Workspace::*which, bool derivatives);
    /// Shear along the hair of one pair; likewise.
    double add_shear(FrozenPair& pair, Evaluation Workspace::*which, bool derivatives);

    std::span<Solver> solvers_;
    std::span<FrozenPair> pairs_;
    const CouplingLaw& law_;
    double value_ = 0, trial_value_ = 0;
    Recycled<Recycled<Vec3>> own_slope_, trial_slope_;
    Recycled<double> gradient_, step_;
};

}  // namespace tuft::brush::rod
