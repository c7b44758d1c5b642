#pragma once

#include <span>

#include "brush/papers/spine_model.h"
#include "brush/preset/preset.h"
#include "brush/preset/rest_shape.h"
#include "brush/rod/coupled/coupled_rods.h"
#include "brush/rod/rod.h"
#include "brush/state/tuft_state.h"
#include "brush/tuft/bundles.h"
#include "brush/tuft/geometry_tuft.h"
#include "brush/tuft/table.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// The tuft of one brush: its persistent state, and the step that bends it against contact planes. `contact` calls
/// `step` for every sample. Deterministic.
///
/// The shape is quasi-static, without masses. Time enters through damping, through recovery of the set, and through
/// the device force f. f follows the surface force F like a critically damped oscillator, the mass of the wet hair:
///
///     f'' = ω² (F − f) − 2 ω f',   1/ω = kDeviceForceTime.
///
/// When a tip slips off an edge, F falls in less than a millisecond, but f changes by at most a tenth of F in any
/// millisecond. Energies are computed with F.
namespace tuft::brush {

/// 1/ω of the first bending of a wet tuft, L²/3.52 √(ρ π R²/B0): 2.5 ms for wolf-medium, 3.5 mixed, 5.2 goat.
inline constexpr double kDeviceForceTime = 4e-3;

/// A spine as it stands in the ferrule: constant, but for that of a sub-spine, which is made anew with each split.
struct SpineRest {
    Recycled<double> radius;  ///< [n+1] m; √(a b) where the section is no circle
    /// [n+1] m, half-widths along the ferrule's broad side and across it; empty: a circle of `radius`.
    Recycled<Vec2> section;
    Recycled<Vec2> strip;   ///< corners of its part of the mouth, see ferrule.h; empty: a disc
    double length = 1;      ///< over the tuft's
    double edge_short = 0;  ///< m, see FerruleSpine
    Vec3 root{0};           ///< m, ferrule frame
    double lean = 0;        ///< rad, of the clamp towards +x of the ferrule
    double share = 1;       ///< of the hair
    double root_width = 0;  ///< m, half-width at the root of a sub-spine; 0: that of the ferrule
};

/// Side nodes of a spine after a step: the edges of its spread hair, two to a node, tip first.
struct SideNodes {
    Vec3 direction{1, 0, 0};      ///< unit, ferrule frame: e at the root
    Recycled<Vec3> position;      ///< metres from the root, ferrule frame; or empty
    Recycled<double> flank;       ///< m, their half-widths without walls; or empty
    Recycled<double> shift;       ///< [n+1] m, along e by friction; or empty
    Recycled<signed char> slips;  ///< [n+1] nodes that slipped; or empty
    double energy = 0;            ///< J, stored in their springs by that shift
};

/// One solved spine and its state. Arrays go from root to tip.
struct Spine {
    rod::Rod rod;        ///< lengths and stiffness, in units of L and B0
    rod::Memory memory;  ///< state of joints and contacts
    SpineRest rest;
    /// [n+1] unit, ferrule frame: its x and y carried along the bent spine; or empty.
    Recycled<Vec3> broad, across;
    SideNodes sides;
    Vec2 one_sided{0};   ///< mean direction of splayed hair, across the clamp; see upright_hair.h
    double pressed = 0;  ///< contact energy of the last solve, B0/L
};

/// Two neighbouring spines: how they stand at rest, and what they remember.
struct Beside {
    int first = 0, second = 1;  ///< spines
    Vec2 direction{1, 0};       ///< unit, from the first to the second, ferrule frame
    double face = 0;            ///< m, as in FerruleNeighbours
    Recycled<double> distance;  ///< m, of their axes at rest, at which their hair touches. [m+1]
    Recycled<double> shift;     ///< m, along the hair, of the outboard nodes of facing segments at rest. [m]
    rod::PairMemory memory;
    Recycled<double> gap;  ///< m, between their hair in the last step, negative: pressed together. [m+1] or empty
};

/// What a step changes of a tuft. Assigned to one of the same brush it allocates nothing.
struct TuftBend {
    double wetness = 1;   ///< input, 0 dry … 1 wet: friction, cohesion, plasticity
    double ink_left = 1;  ///< input, ink over capacity: splitting

    Pose pose;           ///< of the last step
    bool posed = false;  ///< false until the first step
    /// K of them, in a row or in a ring (ferrule.h); a tuft of one has it as the trunk of its sub-spines.
    Recycled<Spine> spines;
    Recycled<Beside> beside;  ///< pairs of neighbours
    bool split = false;
    Recycled<Spine> sub_spines;                  ///< sub-spines of the last third, `split_into` of them while split
    double spread = 0;                           ///< separation: 0 none … 1 full
    double branch_width = 0;                     ///< m, semi-axis of the section at their roots
    Vec3 device_force{0}, device_force_rate{0};  ///< device force f, N, and its rate, N/s
    /// For the methods of brush/papers and for foam only; the trunk then follows its nodes, and there are no sub-spines
    /// of ours.
    SpineModelCopy model;
};

/// Persistent state of one tuft. `make_tuft` makes it; a copy is a snapshot.
struct Tuft : TuftBend {
    Preset preset;
    Bundles bundles;                              ///< bundles and bristles
    QueryTable table;                             ///< for the table method only
    std::shared_ptr<const CarriedShape> carried;  ///< geometry or foam that the spines carry; null: none

    Spine& trunk() { return spines.front(); }
    const Spine& trunk() const { return spines.front(); }
    /// A ferrule with several spines, in a row or in a ring; their branches all begin at it.
    bool wide() const { return spines.size() > 1; }
};

/// What a step leaves for being taken again at the same pose with planes that are little different: it need not follow
/// the ferrule again, and starts from the shape that it found.
struct StepStart {
    bool known = false;                     ///< false: the step fills it
    bool in_parts = false;                  ///< the ferrule went in more than one part
    Recycled<Spine> spines;                 ///< before the last of them
    Recycled<rod::PairMemory> pairs;        ///< of the neighbours, likewise
    Pose from;                              ///< where the last part begins
    double dt = 0;                          ///< s, of the last part
    double dissipation = 0;                 ///< of the parts before, B0/L
    Recycled<Recycled<Vec3>> slip;          ///< of the parts before, of each spine as in rod::Result; or none
    Recycled<rod::Guess> guess;             ///< the shape that was found, of each spine
    Recycled<Recycled<double>> pair_force;  ///< normal forces between neighbours that were found; see PairMemory
};

/// Returns a straight tuft; `seed` places its hair. Throws `Error` for values out of range.
Tuft make_tuft(const Preset& preset, std::uint64_t seed = 0);

/// Returns the nodes whose nearest surface planes `step` needs, metres, world: the spine moved rigidly with the
/// ferrule to `pose`, tip first, root last, spine after spine. While split, the nodes of the sub-spines follow in the
/// same order.
Recycled<Vec3> predicted_nodes(const Tuft& tuft, const Pose& pose);

/// Returns the side nodes of the spines moved as in `predicted_nodes`: two to a node, tip first, spine after spine.
/// Empty before the first step.
Recycled<Vec3> predicted_sides(const Tuft& tuft, const Pose& pose);

/// Moves the ferrule to `pose` and bends the tuft against `planes`: one for each node of `predicted_nodes` in that
/// order, or one for all, or none (free in air). `walls` are planes beside the spines, one for each of
/// `predicted_sides`, or none; they limit the side nodes and push the spine. One for each node of the spines may
/// follow, which it meets besides its own, as across a groove; a normal of zero means none. `dt` is in seconds since
/// the last step. The result is finite and the time is bounded; `converged` is false when the solver stopped early.
/// Throws `Error` when the number of planes or walls fits none of these cases, or when the pose is not finite or its
/// rotation not a unit quaternion. Cost: 20–60 µs for a spine of 16 segments.
///
/// `start`: null, or what the first of several steps from one state to one pose fills and the others use.
TuftState step(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
               std::span<const ContactPlane> walls = {}, StepStart* start = nullptr);

/// Resets the tuft to its state after `make_tuft`; wetness and ink are retained.
void reset(Tuft& tuft);

/// Combs the hair straight and together: removes the set, branches, separated bundles and contacts. The pose is
/// retained.
void reshape(Tuft& tuft);

/// Returns the force for a haptic device, newtons, world: min(G |f|, limit) in the direction of the filtered force
/// f.
Vec3 device_force(const Preset& preset, const TuftState& state);

}  // namespace tuft::brush
