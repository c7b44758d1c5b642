#pragma once

#include <array>
#include <span>

#include "brush/rod/law.h"
#include "brush/rod/profile.h"
#include "brush/rod/solver_work.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// Discrete elastic rod in frictional contact: the solver of the spine of a tuft. `brush/tuft` calls `solve` for
/// every spine at every sample.
///
/// The rod has n rigid, inextensible segments with bending joints. It is clamped at the root and meets one plane
/// per node. `solve` minimises over the unit tangents t_j
///
///     Π = Σ ψ_j(w_j) + Σ contact(r*−z_i, c_i) + Σ μ N̂_i h(|x_i − a_i|) − F·x_tip
///         + Σ η_j/(2Δt) |w_j − w_j(t0)|²
///
/// with w_j the bend of joint j, z_i the height and x_i the position of contact point i, a_i its sticking anchor,
/// and N̂_i its normal force of the previous pass (outer fixed point). c_i = −t_i·n is the cosine of the angle
/// between hair and inward normal. Hairs end at different lengths, so a point shortens by s along itself: contact =
/// min_s ½ k_e s² + contact(r*−z_i − s c_i).
///
/// Method: Newton; each step is found by elimination along the rod. The clamp carries the twist. Valid for any
/// deflection; second order in the segment length. Cost: 15–50 µs for n = 16, warm start.
///
/// Units: length L and root stiffness B0 are 1; forces are in B0/L², moments and energies in B0/L. Arrays go from
/// root to tip.
///
/// Sources: [Bergou2008] (discrete rods), [Chu2002] and [VanLaerhoven2007] (friction as energy with
/// lagged normal force); see README.
namespace tuft::brush::rod {

inline constexpr int kFibres = 16;

/// A rod of n segments, in units of L and B0.
struct Rod {
    Recycled<double> length;     ///< [n] segment lengths
    Recycled<double> stiffness;  ///< [n] joint k_j; joint j sits at the root of segment j
    Recycled<double> yield;      ///< [n] joint angle θ_e where yielding starts; infinite: elastic
    Recycled<double> weight;     ///< [n+1] tributary length of each node
    double plastic_share = 1;    ///< part of k_j in stops that yield; the rest stays elastic
    double buckling = 0;         ///< least load that buckles it as a column with its tip pinned
    int segments() const { return static_cast<int>(length.size()); }
};

/// Returns a rod of n segments (see `spine_segments`) with joint stiffness k_j = 1 / ∫ ds/B over half a segment to
/// each side of the joint.
Rod make_rod(const Profile& profile, int n, double tip_ratio);
/// The same for given segment lengths, root to tip, with sum 1.
Rod make_rod(const Profile& profile, std::span<const double> lengths);

/// Returns the segments from `first` to the tip as a rod with 1/share of the stiffness, in units of the whole. Its
/// clamp is the segment before `first`.
Rod outer_part(const Rod& rod, int first, double share);

/// Returns the buckling load of a straight rod whose tip is pinned and pressed end-on, in B0/L². It is the least
/// eigenvalue P of Σ k_j (θ_j − θ_{j-1})² − P Σ l_j θ_j² on Σ l_j θ_j = 0.
double buckling_load(const Rod& rod);

/// Root of the rod. `side` is a unit vector normal to `tangent`: the reference for the ferrule's rotation about its
/// axis.
struct Clamp {
    Vec3 position{0};
    Vec3 tangent{0, 0, -1};
    Vec3 side{1, 0, 0};
};

/// Contact plane of a node. A node closer than `radius` is pushed out. Near a convex edge `beyond` is the plane of
/// the second face.
struct Obstacle {
    Vec3 origin{0};
    Vec3 normal{0, 0, 1};
    double radius = 0;
    Vec3 beyond_origin{0};
    Vec3 beyond_normal{0};  ///< zero: no edge near

    bool at_edge() const { return beyond_normal != Vec3{0}; }
};

/// A second, one-sided contact plane of a node, with `share` of the law's stiffness. It acts when the node is
/// closer than `radius`. Near a convex edge `beyond` is the plane of the second face.
struct Wall {
    int node = 0;
    Vec3 origin{0}, normal{0, 0, 1};
    double radius = 0;
    double share = 0;  ///< 0: nothing
    Vec3 beyond_origin{0};
    Vec3 beyond_normal{0};  ///< zero: no edge near
};

/// External load at the tip, in units of L and B0.
struct Load {
    Vec3 tip_force{0};
    double end_moment = 0;  ///< about e = tangent × toward of the clamp; positive bends towards `toward`
    Vec3 toward{1, 0, 0};
};

/// Where a solve starts in place of the rod moved with its clamp, if Π is lower there.
struct Guess {
    Recycled<Vec3> tangent;  ///< [n] unit, world
    Recycled<double> force;  ///< of the contact points, normal force
};

/// What acts on a rod in one solve, in units of L and B0. The spans are read during the call only.
struct SolveInput {
    std::span<const Obstacle> obstacles;  ///< [n+1] contact plane of each node; empty: no contact
    Law law;                              ///< of contact and joints, with the solver's limits
    Load load;                            ///< at the tip; default: none
    /// Empty: none. They need obstacles, and have the same order in every solve of one `Memory`. A wall out of reach
    /// changes no bit.
    std::span<const Wall> walls;
    const Guess* guess = nullptr;  ///< null: extrapolated from the last solve
};

/// Plastic state of a joint: parallel elastic-plastic elements in the frame of its inner segment.
struct JointMemory {
    std::array<Vec2, kFibres> stop{};  ///< s_f, elastic strain of element f
    Vec2 bend{0};                      ///< w of the last solve
    bool yielded = false;              ///< false: every strain equals the bend
};

/// Friction state of one contact point.
struct ContactMemory {
    bool touching = false;
    Vec3 anchor{0};
    Vec3 normal{0};         ///< of the surface at the last solve; x - anchor is normal to it
    double force = 0;       ///< normal force of the last solve
    double growth = 0;      ///< ratio to the force of the previous solve
    double multiplier = 0;  ///< hard contact
};

/// State of the rod from one solve to the next.
struct Memory {
    Clamp clamp;
    Recycled<Vec3> tangent;  ///< [n] unit
    /// [n] change of each tangent in the last solve, clamp's frame, for the first guess; or empty.
    Recycled<Vec3> turn;
    double moved = 0;                 ///< displacement of the clamp in the last solve
    Recycled<Vec3> node;              ///< [n+1]
    Recycled<JointMemory> joint;      ///< [n]
    Recycled<ContactMemory> contact;  ///< [points_per_segment n + 1], then one per wall
};

/// Result of one solve, in units of L and B0.
struct Result {
    bool converged = false;
    int iterations = 0, passes = 0;
    SolverWork work;
    double bend_energy = 0;  ///< stored in the joints
    /// Stored in indented and sticking contacts and in the wet film (negative while it attracts).
    double contact_energy = 0;
    double dissipation = 0;         ///< by yielding, slip and damping in this solve
    Recycled<double> moment;        ///< [n] |m| at the joints
    Recycled<double> normal_force;  ///< [n+1], of the contact points, distributed to the nodes
    Recycled<Vec3> contact_force;   ///< [n+1] on the rod, friction and walls included
    Recycled<Vec3> wall_force;      ///< [n+1] part of it from walls; empty without walls
    Recycled<Vec3> slip;            ///< [n+1] displacement of the slipping hair over the surface, weighted by friction
    Recycled<Obstacle> met;         ///< [n+1] the plane that each node meets at its final position, or empty
    Vec3 force{0};                  ///< sum of contact forces
    Vec3 root_moment{0};            ///< of all external forces about the root
};

/// Returns a straight rod along the clamp's tangent.
Memory make_memory(const Rod& rod, const Clamp& clamp);

/// Moves the rod rigidly with the clamp to a new pose.
void move_with_clamp(Memory& memory, const Clamp& clamp);

/// Rotates the rod about its clamp's axis by `angle` radians, with its set and its friction anchors. The clamp does
/// not move.
void turn_about_clamp(Memory& memory, double angle);

/// Returns the nodes root + Σ l_j t_j. [n+1]
Recycled<Vec3> nodes(const Rod& rod, const Memory& memory);

/// Moves the rod rigidly to `clamp`, then minimises Π. Never throws. The work is bounded: when it stops early, the
/// best state is retained and `converged` is false.
Result solve(const Rod& rod, Memory& memory, const Clamp& clamp, const SolveInput& input);

/// Value and derivatives of Π at one place, for tests.
struct Probe {
    double value = 0;
    Recycled<double> gradient;
    Recycled<double> hessian;  ///< [2n × 2n] lower half, column major
    /// Newton step, with `damping` times the joint stiffness added to each segment's pivot; empty where that is
    /// not positive definite.
    Recycled<double> step;
};
/// Returns Π and its derivatives for frozen friction after the steps x [2n] from the state in `memory`: two for each
/// segment, along its normals, in radians. `damping` ≥ 0 enters the Newton step only.
Probe probe_energy(const Rod& rod, const Memory& memory, const SolveInput& input, std::span<const double> x,
                   double damping = 0);

}  // namespace tuft::brush::rod
