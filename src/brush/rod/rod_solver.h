#pragma once

#include <algorithm>
#include <span>

#include "brush/rod/rod.h"
#include "brush/rod/rod_energy.h"
#include "brush/rod/rod_newton.h"
#include "brush/rod/rod_points.h"
#include "core/system/recycled.h"

/// \file
/// One solve of one rod: friction passes around Newton, then the memory moves on. Internal to the rod solver; coupled
/// rods (coupled_rods.h) run their solvers side by side.
namespace tuft::brush::rod {

/// Line searches of one solve, all passes together, that may end at a kink or a jump of Π. Hair over an edge crawls
/// along a jump by steps of a thousandth of Newton's, with a residual that no step lowers. Without edges Π has no
/// jumps.
inline constexpr int kMostStalls = 8;
inline constexpr int kPassStalls = 3;  ///< of one pass: with friction frozen anew the jump may be elsewhere
/// Returns how many searches a pass may spend so, after `stalls` of the solve.
inline int stalls_left(const Law& law, int stalls) {
    return law.edge > 0 ? std::min(kPassStalls, kMostStalls - stalls) : law.limits.max_iterations;
}

/// Returns how far a clamp went, turns counted at one length.
double clamp_distance(const Clamp& a, const Clamp& b);

/// Normal forces and anchors from which the friction of a pass is frozen, of the contact points.
struct LaggedContact {
    Recycled<double> normal;  ///< N̂
    Recycled<Vec3> anchor;
    Recycled<char> anchored;
    Recycled<double> last_miss;  ///< of N̂ in the pass before
};

/// Buffers of one thread, reused so that a warm solve allocates little.
struct Buffers {
    Recycled<Vec3> before;    ///< nodes of the last solve
    Recycled<Obstacle> fine;  ///< of the contact points
    Frozen frozen;
    Shape shape;
    LaggedContact lagged;
    Recycled<double> friction_sum;  ///< [n+1] most friction of the points beside each node
    Workspace newton;
};

/// What a pass changed of the normal forces that its friction is frozen from, and its forces: sums, B0/L².
struct ForceChange {
    double change = 0, sum = 0;
};

/// Residual to which a pass is solved whose friction comes from forces that changed so: a pass need not be more exact
/// than its friction.
double pass_tolerance(const ForceChange& forces);

/// Course of the friction passes of one solve.
struct PassState {
    double relaxation = 1;        ///< of N̂ towards the normal forces of a pass
    bool forces_changed = false;  ///< the last `take_normal_forces` changed what friction is frozen from
    ForceChange forces;           ///< of the pass before; of the first one, what it is expected to change
    int stalls = 0;
};

/// One solve: friction passes around Newton, then the memory moves on.
struct Solver {
    const Rod& rod;
    Memory& memory;
    std::span<const Obstacle> obstacles;  ///< of the nodes
    std::span<const Wall> walls;
    const Law& law;
    Buffers& buffers;
    double moved = 0;  ///< of the clamp since the last solve
    Recycled<Obstacle>& fine = buffers.fine;
    Frozen& frozen = buffers.frozen;
    Shape& shape = buffers.shape;
    LaggedContact& lagged = buffers.lagged;
    Workspace& ws = buffers.newton;
    double recovered = 0;  ///< energy lost by the set going back
    PassState passes;
    SolverWork work;

    int n() const { return rod.segments(); }
    bool touches() const { return passes.forces.sum > 0; }

    void begin(const Load& load, const Recycled<Vec3>& before);
    /// Returns the anchor of a point that stuck at `last`. Its stretch along the surface is transported with the
    /// surface's normal, so that neither a rounded edge nor a change of planes pulls at it.
    Vec3 transported_anchor(std::size_t p, const ContactMemory& c, const Vec3& last) const;
    const PointPlace& place(std::size_t p) const { return frozen.points.place[p]; }
    Vec3 point(const Recycled<Vec3>& x, std::size_t p) const { return frozen.points.stencil[p].at(x); }
    Distance distance(std::size_t p, const Vec3& x) const;
    /// The plane that a contact point meets, and its unit normal.
    Obstacle met_at(std::size_t p, const Recycled<Vec3>& x) const { return met_by(frozen, static_cast<int>(p), x); }
    Vec3 normal_at(std::size_t p, const Recycled<Vec3>& x) const;
    /// Freezes friction for the hair where it lies at nodes x along `tangents`.
    void freeze_friction(const Recycled<Vec3>& x, const Recycled<Vec3>& tangents);
    /// Hair that stands may buckle: neither its friction nor its forces go on as they did.
    bool stands() const;
    /// Displacement of the clamp in this solve over that of the last, 0–2; 0 where it did not move.
    double step_ratio() const { return memory.moved > 0 ? std::min(2.0, moved / memory.moved) : 0; }
    /// Prepares another shape to start from in ws.next, with its nodes, and friction frozen for it: that of the guess
    /// with its normal forces, else the present one extrapolated by the change of the last solve, with the friction of
    /// the present one where the hair stands. Returns false where neither is known.
    bool propose_shape(const Guess* guess);
    /// Starts from the proposed shape where Π is lower there with the friction of that shape. Else it
    /// starts from the shape that moved rigidly with the clamp: friction frozen there points the wrong way and costs
    /// passes.
    void start(const Guess* guess);
    /// Whether its passes must be exact: hair that stands under a load may buckle, which grows from what is left.
    bool is_exact() const { return law.normal.hard || (touches() && stands()); }
    ForceChange change_of_forces() const;
    bool is_settled(const ForceChange& forces) const;
    /// Whether the normal forces of the pass are those that its friction is frozen from.
    bool forces_settled() const { return is_settled(change_of_forces()); }
    /// Takes the normal forces of the pass; true when they no longer change.
    bool take_normal_forces(int pass);
    /// Moves N̂ towards the pass' normal forces, by Aitken's rule from the second pass on:
    /// friction lifts or lowers the tuft, so that plain substitution can swing to and fro.
    void relax(int pass);
    /// Takes the change that the first pass is expected to make: none beyond the law's tolerance.
    void expect_forces();
    /// Minimises Π with the friction of this pass, within what `done` leaves of the law's iterations.
    NewtonResult minimise_pass(double tolerance, Result& done);
    Result run(const Guess* guess = nullptr);
    /// Forces from the last evaluation; stops and anchors move on.
    void finish(Result& out);
    void finish_contact(std::size_t p, Result& out);
};

}  // namespace tuft::brush::rod
