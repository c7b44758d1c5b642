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
    return law.edge > 0 ? std::min(kPassStalls, kMostStalls - stalls) : law.max_iterations;
}

/// Returns how far a clamp went, turns counted at one length.
double clamp_distance(const Clamp& a, const Clamp& b);

/// Buffers of one thread, reused so that a warm solve allocates little.
struct Buffers {
    Recycled<Vec3> before;    ///< nodes of the last solve
    Recycled<Obstacle> fine;  ///< of the contact points
    Frozen frozen;
    Shape shape;
    Recycled<double> normal;  ///< lagged N̂
    Recycled<Vec3> anchor;
    Recycled<char> anchored;
    Recycled<double> last_miss;     ///< of N̂ in the pass before
    Recycled<double> friction_sum;  ///< [n+1] most friction of the points beside each node
    Workspace newton;
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
    Recycled<double>& normal = buffers.normal;
    Recycled<Vec3>& anchor = buffers.anchor;
    Recycled<char>& anchored = buffers.anchored;
    Workspace& ws = buffers.newton;
    double relaxation = 1;
    double recovered = 0;  ///< energy lost by the set going back
    /// The last `take_normal_forces` changed what friction is frozen from.
    bool forces_changed = false;
    double force_change = 0, force_sum = 0;  ///< sums of those changes and of the forces, B0/L²
    int stalls = 0;
    SolverWork work;

    int n() const { return rod.segments(); }

    void begin(const Load& load, const Recycled<Vec3>& before);
    /// Returns the anchor of a point that stuck at `last`. Its stretch along the surface is transported with the
    /// surface's normal, so that neither a rounded edge nor a change of planes pulls at it.
    Vec3 transported_anchor(std::size_t p, const ContactMemory& c, const Vec3& last) const;
    const PointPlace& place(std::size_t p) const { return frozen.place[p]; }
    Vec3 point(const Recycled<Vec3>& x, std::size_t p) const { return frozen.stencil[p].at(x); }
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
    /// Extrapolates the shape and its nodes by the change of the last solve. Returns false where that is not known.
    bool extrapolate_shape();
    /// Takes the guess for the extrapolated shape, and its normal forces.
    void take_guess(const Guess& guess);
    /// Freezes friction for the extrapolated shape, or for the present one where the hair stands.
    void freeze_extrapolated();
    /// Starts from the guess or the extrapolated shape where Π is lower there with the friction of that shape. Else it
    /// starts from the shape that moved rigidly with the clamp: friction frozen there points the wrong way and costs
    /// passes.
    void start(const Guess* guess);
    /// Residual to which this pass is solved: a pass need not be more exact than its friction. 0 where hair stands,
    /// whose buckling grows from what is left.
    double pass_tolerance() const;
    /// Whether the normal forces of the pass are those that its friction is frozen from.
    bool forces_settled() const;
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
