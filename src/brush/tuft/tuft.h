#pragma once

#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/rod/rod.h"
#include "brush/tuft/bundles.h"
#include "brush/tuft/table.h"
#include "brush/tuft/tuft_state.h"
#include "core/geometry/types.h"

/// The tuft of one brush as it is moved: what persists from sample to sample, and the
/// step that bends it. The shape is quasi-static, without masses; time only matters to the damping
/// of what snaps, to the set that recovers, and to what the ferrule feels: the force of the surface
/// comes to it through the mass of the wet hair, as through an oscillator of critical damping,
///
///   f'' = ω² (F - f) - 2 ω f',   1/ω = kDeviceForceTime,
///
/// so that a tip that slips off an edge (F falls in less than a millisecond) is felt as no more than
/// a tenth of F in any one. Energy is accounted for with F. Everything is deterministic.
namespace tuft::brush {

/// 1/ω of the first bending of a wet tuft, L²/3.52 √(ρ π R²/B0): 2.5 ms for wolf-medium, 3.5 mixed, 5.2 goat.
inline constexpr double kDeviceForceTime = 4e-3;

/// One solved spine with what it remembers. Arrays go from root to tip.
struct Spine {
    rod::Rod rod;                     ///< lengths and stiffness, in units of L and B0
    rod::Memory memory;               ///< joints, contacts
    std::vector<double> rest_radius;  ///< [n+1] m
    Vec3 wide{1, 0, 0};               ///< unit, ferrule frame: direction e at the root of the last step
    double root_width = 0;            ///< m, half-width at the root, of a sub-spine; 0: the ferrule's
    Vec2 one_sided{0};                ///< mean direction of splayed hair, across the clamp; see splay.h
    std::vector<Vec3> side;           ///< side nodes of the last step, metres from the root, ferrule
                                      ///< frame, tip first, two to a node; or none
    std::vector<double> flank;        ///< m, half-widths as those side nodes have them where no wall is; or none
    std::vector<double> aside;        ///< [n+1] m, how far friction has shifted the side nodes along e, or none
    std::vector<signed char> slips;   ///< [n+1] which of them slipped in the last step, or none
    double aside_energy = 0;          ///< J, that their springs hold by this
    double pressed = 0;               ///< contact energy of the last solve, B0/L
};

/// The persistent state of one tuft. Make it with `make_tuft`; copying it is a snapshot.
struct Tuft {
    Preset preset;
    double wetness = 1;   ///< input, 0 dry … 1 wet: friction, cohesion, plasticity
    double ink_left = 1;  ///< input, ink over capacity: splitting

    Pose pose;           ///< of the last step
    bool posed = false;  ///< false until the first step
    Spine spine;
    bool split = false;
    std::vector<Spine> sub_spines;               ///< sub-spines of the last third, `split_into` of them while split
    double spread = 0;                           ///< how far they have parted: 0 still one point … 1 fully
    double branch_width = 0;                     ///< m, semi-axis of the section that they leave from
    Vec3 device_force{0}, device_force_rate{0};  ///< force that came through to the ferrule, N, and its rate, N/s
    Bundles bundles;                             ///< the hair within
    QueryTable table;                            ///< for the table method only
};

/// A straight tuft of this make; `seed` lays its hair. Throws `Error` for values out of range.
Tuft make_tuft(const Preset& preset, std::uint64_t seed = 0);

/// Nodes whose nearest surface `step` wants to know, metres, world: the spine carried
/// rigidly with the ferrule to `pose`; tip first, root last; while split, the nodes of
/// the sub-spines follow in the same order.
std::vector<Vec3> predicted_nodes(const Tuft& tuft, const Pose& pose);

/// Side nodes of the spine, as `predicted_nodes`: two to a node, tip first; none before the
/// first step.
std::vector<Vec3> predicted_sides(const Tuft& tuft, const Pose& pose);

/// Moves the ferrule to `pose` and bends the tuft against the planes: one for each node
/// of `predicted_nodes`, in that order; or one that serves all; or none (free in air).
/// `walls`: what the side nodes meet beside the spine, one for each of `predicted_sides`, or none; they hold the
/// sides and push the spine.
/// `dt` in seconds since the last step. Always finite and in bounded time: `converged`
/// is false where it stopped early. Cost: 20–60 µs at 16 segments.
/// Throws nothing but `Error`: the number of planes or walls fits none of these cases, or the pose
/// is not finite and of unit rotation.
TuftState step(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
               std::span<const ContactPlane> walls = {});

/// Forgets everything that happened since `make_tuft`; wetness and ink stay.
void reset(Tuft& tuft);

/// The hand combs the hair straight and together: permanent set, branches, parted bundles
/// and contacts are gone; the pose stays.
void reshape(Tuft& tuft);

/// What the hand feels, newtons, world: min(G |f|, limit) along the force f that has come through.
Vec3 device_force(const Preset& preset, const TuftState& state);

/// The preset's stiffness and yield along the hair.
Profile profile_of(const Preset& preset);

/// Radius of the resting tuft, metres: 1.06 R (1-u^2.4)^q (1 - 0.14 (1-u)^6), u from root
/// to tip, and the tip's own radius added by squares.
double rest_radius(const Preset& preset, double u);

}  // namespace tuft::brush
