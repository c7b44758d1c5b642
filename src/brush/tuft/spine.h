#pragma once

#include <span>

#include "brush/tuft/tuft.h"

/// Inside of the tuft: one spine between the ferrule and its contact planes.
namespace tuft::brush {

struct Solved {
    rod::Result result;  ///< in units of L and B0
    Branch branch;
    double spread_energy = 0;  ///< J, in the springs of the side nodes, part of the rod's
    double aside_gain = 0;     ///< J, that friction has brought to them since the last step
};

/// What happened on the way to a pose, in units of L and B0.
struct Passed {
    double dissipation = 0;
    std::vector<Vec3> slip;  ///< [n+1] as in rod::Result; or none
};

rod::Clamp clamp_of(const Preset& preset, const Pose& pose);

/// A straight spine whose root lies at ξ0 of the hair, one of `share`.
Spine make_spine(const Preset& preset, const rod::Rod& rod, const rod::Clamp& clamp, double xi0, double share);

/// Follows the ferrule from `from` to just before `to` in parts small enough, and lets
/// hair that stands upright fall behind the motion. `dt`: in, seconds of the whole way; out,
/// of the part that is left.
Passed approach(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                std::span<const ContactPlane> planes, std::span<const ContactPlane> walls, double wetness, double& dt);

/// The spine bent by the rod solver over `dt` seconds; `turn` is the ferrule's rotation, `planes` and `walls` tip
/// first. What `passed` before in this step is added to the result's.
Solved solve_spine(const Preset& preset, Spine& spine, const rod::Clamp& clamp, const Quat& turn,
                   std::span<const ContactPlane> planes, double wetness, double share, double dt,
                   std::span<const ContactPlane> walls = {}, const Passed& passed = {});

/// The spine from the query table: bent in the plane of the holder and the tip's last place,
/// so that the tip follows the hand as a tractrix, by the moment that puts the tip on the plane.
Solved stand_spine(const Preset& preset, const QueryTable& table, Spine& spine, const rod::Clamp& clamp,
                   const Quat& turn, std::span<const ContactPlane> planes, double wetness);

/// SP = ξ k (1 - Z_i/Z) of the bifurcation rule, k the root moment over that of a tuft that
/// lies flat.
double split_measure(const Preset& preset, double ink_left, double root_moment);

/// Parts the last third of the spine into `split_into` sub-spines n with as much hair each:
/// radius r/√n, stiffness B/n, ink Z/n, yaw Δ (j − (n − 1)/2).
/// They begin side by side over the width of the trunk and meet in the tip; `Tuft::spread` parts them.
void split(Tuft& tuft, const Branch& whole);

/// Solves the sub-spines on the bent trunk and puts them in place of the last third.
void solve_sub_spines(Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state, double dt);

}  // namespace tuft::brush
