#pragma once

#include <span>

#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"

/// \file
/// One spine of the tuft between the ferrule and its contact planes. Internal to `brush/tuft`.
namespace tuft::brush {

/// One spine after a solve.
struct SolvedSpine {
    rod::Result result;  ///< in units of L and B0
    Branch branch;
    double spread_energy = 0;  ///< J, in the springs of the side nodes; part of the rod's energy
    double aside_gain = 0;     ///< J, work of friction on them since the last step
};

/// Dissipation and slip on the path to a pose, in units of L and B0.
struct PathWork {
    SolverWork work;
    double dissipation = 0;
    Recycled<Vec3> slip;  ///< [n+1] as in rod::Result; or none
};

/// A neighbouring spine at the nodes, root first. A spine's sections end where both touch.
struct Neighbour {
    Recycled<Vec3> apart;   ///< m, displacement to it
    Recycled<double> part;  ///< own half-width over the distance of both at rest
};
using Neighbours = Recycled<Neighbour>;

/// Returns the clamp of a spine in the middle of the ferrule.
rod::Clamp clamp_of(const Preset& preset, const Pose& pose);

/// Contact law in units of L and B0 of one of `share` equal spines, for a solve over `dt` seconds.
rod::Law law_of(const Preset& preset, double wetness, double share, double dt);

/// Returns the planes of a spine's nodes (tip first, or one for all, or none) as obstacles of its rod (root first).
/// `reach(i, normal)`: of the hair about node i from its centre, metres.
template <class Reach>
Recycled<rod::Obstacle> obstacles_from(const Preset& preset, const Spine& spine, std::span<const ContactPlane> planes,
                                       const Reach& reach) {
    const std::size_t count = spine.rest.radius.size();
    const double length = preset.length;
    Recycled<rod::Obstacle> out;
    if (planes.empty()) return out;
    out.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const ContactPlane& plane = planes.size() == 1 ? planes[0] : planes[count - 1 - i];
        out[i] = {plane.origin / length, plane.normal, reach(i, plane.normal) / length, plane.beyond_origin / length,
                  plane.beyond_normal};
    }
    return out;
}

/// Number of parts in which a tuft whose tip is bent by `bend` radians follows its ferrule from one pose to another.
int count_substeps(const Preset& preset, const Pose& from, const Pose& to, double bend);

/// Where the tip of straight hair would be, and where hair falls that nothing else turns aside.
struct StraightHair {
    Vec3 tip{0};          ///< metres, world
    Vec3 aside{1, 0, 0};  ///< unit, ferrule frame
    Vec3 taken{0};        ///< unit, world: where it falls in any case; zero: nothing says so
};
/// Bends nearly straight hair that is pressed along its axis a little: behind the hand's motion, or to `aside`.
void break_symmetry(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                    std::span<const ContactPlane> planes, const StraightHair& upright);

/// What one spine meets in a step.
struct SpineStep {
    const Preset& preset;
    rod::Clamp clamp;                      ///< of its root at the end of the step
    Quat rotation{1, 0, 0, 0};             ///< of the ferrule
    std::span<const ContactPlane> planes;  ///< of its nodes, tip first; or one for all; or none
    std::span<const ContactPlane> walls;   ///< beside its side nodes, tip first, two to a node; or none
    std::span<const ContactPlane> across;  ///< facing the planes of its nodes, tip first; or none
    double wetness = 1;                    ///< 0 dry … 1 wet
    double share = 1;                      ///< number of equal spines that share the hair
    double dt = 0;                         ///< s
};

/// The rod of a spine after a step.
struct SolvedRod {
    rod::Result result;                        ///< units of L and B0
    std::span<const Vec3> node;                ///< [n+1] positions of the hair, units of L
    std::span<const rod::Obstacle> obstacles;  ///< [n+1] units of L, or none
    std::span<const Vec3> along = {},
                          broad = {};  ///< [n+1] node_tangents and broad_axes, where they are known; or none
};

/// Makes the sections of a solved spine.
SolvedSpine finish_spine(const SpineStep& step, Spine& spine, SolvedRod rod, const Neighbours& neighbours = {});

/// Returns a straight spine with its root at ξ0 of the hair and `share` of the hair.
Spine make_spine(const Preset& preset, const rod::Rod& rod, const rod::Clamp& clamp, double xi0, double share);

/// Moves the spine from pose `from` to just before `to` in small steps, and turns upright hair behind the motion.
/// `step.dt`: on entry seconds of the whole motion, on return seconds of the remaining part. `start` as in
/// `brush::step`.
PathWork follow_ferrule(SpineStep& step, Spine& spine, const Pose& from, const Pose& to, StepStart* start = nullptr);

/// Solves the spine with the rod solver. Adds `passed`, the earlier part of this step, to the result.
SolvedSpine solve_spine(const SpineStep& step, Spine& spine, const PathWork& passed = {},
                        const rod::Guess* guess = nullptr);

/// Solves the spine with the query table. It is bent in the plane of the holder and the tip's last position, so
/// that the tip follows the hand as a tractrix, by the moment that places the tip on the plane.
SolvedSpine bend_by_table(const SpineStep& step, const QueryTable& table, Spine& spine);

/// Returns SP = ξ k (1 − Z_i/Z) of the bifurcation rule. k is the root moment over that of a tuft lying flat.
double split_measure(const Preset& preset, double ink_left, double root_moment);

/// Splits the last third of the spine into n = `split_into` sub-spines of equal hair: radius r/√n, stiffness B/n,
/// ink Z/n, yaw Δ (j − (n − 1)/2). They start side by side over the width of the trunk and meet in the tip;
/// `Tuft::spread` separates them.
void split(Tuft& tuft, const Branch& whole);

/// Solves the sub-spines on the bent trunk. They replace the last third of it.
void solve_sub_spines(Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state, double dt);

}  // namespace tuft::brush
