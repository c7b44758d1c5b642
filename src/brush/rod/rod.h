#pragma once

#include <array>
#include <span>
#include <vector>

#include "brush/rod/profile.h"
#include "core/geometry/types.h"

/// Inextensible discrete rod of n rigid segments with bending joints, clamped at the root,
/// in frictional contact with one plane per node. Minimises
///
///   Π = Σ ψ_j(w_j) + Σ contact(r*-z_i, c_i) + Σ μ N̂_i h(|x_i - a_i|) - F·x_tip
///       + Σ η_j/(2Δt) |w_j - w_j(t0)|²
///
/// with c_i = -t_i·n how much the hair meets the surface end-on: the ends of the hairs are not
/// of one length, so that a point gives a way s along itself, by the potential
/// min_s ½ k_e s² + contact(r*-z_i - s c_i).
///
/// over unit tangents t_j by Newton, whose steps are found by elimination along the rod; N̂ is the normal
/// force of the pass before (outer fixed point), a_i the sticking anchor. Twist is carried
/// by the clamp. Valid for any deflection; second order in the segment length.
///
/// Units: length L and root stiffness B0 are 1; forces B0/L², moments B0/L, energy B0/L.
/// Arrays go from root to tip. Cost: 15–50 µs for n = 16, warm.
/// Source: Bergou et al. 2008 (discrete rods), Chu and Tai 2002 and Van Laerhoven 2007
/// (friction as energy with lagged normal force); see README.
namespace tuft::brush::rod {

inline constexpr int kFibres = 16;
inline constexpr int kMaxSegments = 128;

struct Rod {
    std::vector<double> length;     ///< [n] segment lengths
    std::vector<double> stiffness;  ///< [n] joint k_j; joint j sits at the root of segment j
    std::vector<double> yield;      ///< [n] joint angle θ_e where yielding starts; infinite: elastic
    std::vector<double> weight;     ///< [n+1] tributary length of each node
    double plastic_share = 1;       ///< part of k_j in stops that yield; the rest stays elastic
    double buckling = 0;            ///< least load that buckles it as a column with its tip held
    int segments() const { return static_cast<int>(length.size()); }
};

/// The beam cut into segments (see `spine_segments`): k_j = 1 / ∫ ds/B over the joint's
/// share, half a segment to each side.
Rod make_rod(const Profile& profile, int n, double tip_ratio);
/// The same for any segment lengths, root to tip, of sum 1.
Rod make_rod(const Profile& profile, std::span<const double> lengths);

/// Segments from `first` to the tip as a rod of their own, with 1/share of the stiffness;
/// still in units of the whole. Its clamp is the segment inboard of `first`.
Rod outer_part(const Rod& rod, int first, double share);

/// Least eigenvalue P of Σ k_j (θ_j - θ_{j-1})² - P Σ l_j θ_j² on Σ l_j θ_j = 0: the load at
/// which a straight rod pressed end-on by a point that holds its tip bows out. B0/L².
double buckling_load(const Rod& rod);

/// Root of the rod. `side` is a unit vector normal to `tangent` that marks the ferrule's turn.
struct Clamp {
    Vec3 position{0};
    Vec3 tangent{0, 0, -1};
    Vec3 side{1, 0, 0};
};

/// Plane that a node meets: it is pushed out when closer than `radius`. Near a convex edge
/// also the plane beyond it.
struct Obstacle {
    Vec3 origin{0};
    Vec3 normal{0, 0, 1};
    double radius = 0;
    Vec3 beyond_origin{0};
    Vec3 beyond_normal{0};  ///< zero: no edge near

    bool at_edge() const { return beyond_normal != Vec3{0}; }
};

/// What a node meets beside its own plane, one-sided too: with `share` of the law's stiffness, closer than `radius`.
struct Wall {
    int node = 0;
    Vec3 origin{0}, normal{0, 0, 1};
    double radius = 0;
    double share = 0;  ///< 0: nothing
};

/// Contact law of all nodes.
struct Law {
    int points_per_segment = 1;  ///< contact points: the nodes, and this less one between them,
                                 ///< whose planes and radii are interpolated
    bool hard = false;           ///< exact non-penetration by an augmented Lagrangian
    double stiffness = 1e4;      ///< k_c, force per length per indentation; penalty when hard
    double core_stiffness = 0;   ///< further k beyond core_start · radius
    double core_start = 0.65;
    double onset = 0;              ///< indentation over which a stiffness comes in, smoothing its kink
    double end_friction = 1;       ///< share of μ that is left where hair meets the surface end-on; the
                                   ///< rest comes with lying down, as sin² of its angle to the normal
    double recovery = 0;           ///< Δt/T of the set: stops that push the hair back towards straight
                                   ///< creep; see `recover_joint`
    double end_compliance = 0;     ///< length by which the hair's ends give at the buckling load
                                   ///< when they meet a surface end-on, less the more they lie;
                                   ///< 0: none. Fades to nothing 4 end_compliance behind the tip
    double damping = 0;            ///< viscous stiffness over elastic stiffness of the joints:
                                   ///< η/(k Δt) of backward Euler
    double edge = 0;               ///< over a crease, where a node has two planes or the planes of
                                   ///< neighbouring nodes part, a point keeps off both (in a corner) or
                                   ///< either (over an edge), rounded by this length as in wedge.h;
                                   ///< 0: one plane each
    double adhesion = 0;           ///< pull per length of a wet node that all but touches, fading
    double adhesion_range = 0;     ///< as (1 - gap/range)² to nothing at this gap
    double friction = 0;           ///< μ
    double grain = 0.5;            ///< κ_f: 2κ_f μ along the tangent, 2(1-κ_f) μ across
    double with_hair = 0;          ///< C_η: μ (1 - C_η cos⁴) when dragged tip last
    double pore_grip = 0;          ///< extra μ of the tip against being pushed tip first
    double stick_stiffness = 4e4;  ///< k_t, tangential force per length per displacement
    int max_passes = 20;           ///< of lagged normal forces
    int max_iterations = 80;       ///< of Newton, all passes together
    double tolerance = 1e-7;       ///< largest residual moment
    double pass_tolerance = 1e-2;  ///< change of normal forces between passes, relative
};

struct Load {
    Vec3 tip_force{0};
    double end_moment = 0;  ///< about e = tangent × toward of the clamp: bends towards `toward`
    Vec3 toward{1, 0, 0};
};

/// What a joint remembers: parallel elastic-plastic stops in the frame of its inner segment.
struct JointMemory {
    std::array<Vec2, kFibres> stop{};  ///< s_f
    Vec2 bend{0};                      ///< w of the last solve
    bool yielded = false;              ///< false: every stop equals the bend
};

struct ContactMemory {
    bool touching = false;
    Vec3 anchor{0};
    Vec3 normal{0};         ///< of the surface at the last solve; x - anchor is normal to it
    double force = 0;       ///< normal force of the last solve
    double growth = 0;      ///< of it over that of the solve before
    double multiplier = 0;  ///< hard contact
};

struct Memory {
    Clamp clamp;
    std::vector<Vec3> tangent;           ///< [n] unit
    std::vector<Vec3> turn;              ///< [n] change of each tangent in the last solve, in the
                                         ///< clamp's frame, for a better first guess; or none
    double moved = 0;                    ///< of the clamp in the last solve
    std::vector<Vec3> node;              ///< [n+1]
    std::vector<JointMemory> joint;      ///< [n]
    std::vector<ContactMemory> contact;  ///< [points_per_segment n + 1], and one for each wall
};

struct Result {
    bool converged = false;
    int iterations = 0, passes = 0;
    double bend_energy = 0;            ///< stored in the joints
    double contact_energy = 0;         ///< stored in indented and sticking contacts and the wet film
                                       ///< (which holds less than none while it draws)
    double dissipation = 0;            ///< by yielding, slip and damping, this solve
    std::vector<double> moment;        ///< [n] |m| at the joints
    std::vector<double> normal_force;  ///< [n+1], shares of the points beside each node
    std::vector<Vec3> contact_force;   ///< [n+1] on the rod, with friction, of walls too
    std::vector<Vec3> wall_force;      ///< [n+1] of it, what walls push; none without walls
    std::vector<Vec3> slip;            ///< [n+1] way of the slipping hair over the surface, mean by friction
    std::vector<Obstacle> met;         ///< [n+1] the one plane that each node meets where it came to
                                       ///< lie, or none
    Vec3 force{0};                     ///< sum of contact forces
    Vec3 root_moment{0};               ///< of all outer forces about the root
};

/// A straight rod along the clamp's tangent.
Memory make_memory(const Rod& rod, const Clamp& clamp);

/// The rod as it would be if carried rigidly with the clamp to a new place.
void carry_with_clamp(Memory& memory, const Clamp& clamp);

/// The rod turned about its clamp's axis by `angle`, with its sets and the places where it sticks;
/// the clamp stays.
void turn_about_clamp(Memory& memory, double angle);

/// Nodes of the rod: root + Σ l_j t_j. [n+1]
std::vector<Vec3> nodes(const Rod& rod, const Memory& memory);

/// Carries the rod to `clamp`, then solves. `obstacles`: [n+1], or empty for none. `walls` come in the same
/// order from solve to solve, and only where there are obstacles; out of reach they change no bit.
/// Bounded work; when it stops early the best state is kept and `converged` is false.
Result solve(const Rod& rod, Memory& memory, const Clamp& clamp, std::span<const Obstacle> obstacles, const Law& law,
             const Load& load = {}, std::span<const Wall> walls = {});

/// Value and derivatives of Π for frozen friction, for tests: x holds 2n steps along each
/// segment's two normals from the state in `memory`.
struct Probe {
    double value = 0;
    std::vector<double> gradient;
    std::vector<double> hessian;  ///< [2n × 2n] its lower half, column major
    std::vector<double> step;     ///< Newton's, each segment's pivot raised by `damping` times the
                                  ///< stiffness of its joints; none where it is not positive definite
};
Probe probe_energy(const Rod& rod, const Memory& memory, std::span<const Obstacle> obstacles, const Law& law,
                   const Load& load, std::span<const double> x, double damping = 0);

}  // namespace tuft::brush::rod
