#pragma once

#include <span>

#include "brush/tuft/ferrule.h"
#include "brush/tuft/spine.h"
#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"

/// \file
/// The spines of a wide ferrule, bent together. Internal to `brush/tuft`; `step` calls it where K > 1.
///
/// Neighbouring spines, in a row or in a ring, are rods coupled by contact, wet film and friction
/// (rod/coupled/coupled_rods.h). Their law in SI units, with t the thickness, γ the surface tension, S the wetness, d
/// the diameter of a hair and φ the part of a tuft that is hair:
///
///     k_n = kHairModulus t/p,   k_s = 0.4 k_n,   W = 2 γ t min(1, S/0.2),
///     g_b = max(2 γ/p_c, √(12 W/k_n)),   p_c = ρ g L + 4 γ φ (1 − S) / ((1 − φ) d).
///
/// k_n is that of a layer of hair of the height t and the thickness p, the pitch of the spines: the coupling of the
/// whole row does not depend on their number. W is Dupré's work of two new faces; t is the thickness of the hair at the
/// node, so that a thin edge holds little, or in a ring the width of the face there. p_c is the suction in the film: of
/// the hanging column of ink, and of the menisci between hairs that are not full [Princen1969]. The least g_b keeps
/// the film's bond stable: its work is at least twice what contact takes of it.
///
/// Spread hair of two neighbours meets with the stiffness of both side springs in series (tuft_sections.h).
namespace tuft::brush {

inline constexpr double kHairModulus = 6e4;  ///< Pa, of packed hair pressed across; a guess

/// Returns the spines of the preset's ferrule, straight, with their root at the pose {}.
Recycled<Spine> make_spines(const Preset& preset, const Profile& profile);
/// Returns the pairs of neighbours of the preset's ferrule at rest.
Recycled<Beside> make_beside(const Preset& preset, std::span<const Spine> spines);

/// Clamp of a spine for a pose of the holder.
rod::Clamp spine_clamp(const Preset& preset, const Spine& spine, const Pose& pose);

/// Returns the law of the coupling in units of L and B0.
rod::CouplingLaw coupling_of(const Preset& preset, double wetness);

/// Returns the half-width of the resting section of node i in the direction of the unit vector n, metres:
/// √((a n·x)² + (b n·y)² + (min(a, b) n·t)²) with x, y the ferrule's axes carried along the spine to the node.
double rest_reach(const Spine& spine, std::size_t i, const Vec3& x, const Vec3& t, const Vec3& n);

/// All spines of a ferrule after a solve.
struct SolvedSpines {
    Recycled<SolvedSpine> spines;
    SolverWork work;
    double coupling_energy = 0, dissipation = 0;  ///< units of B0/L; the latter of all rods and pairs
    double film_range = 0;                        ///< m, gap at which the wet film between two spines breaks
};

/// Moves all spines from the tuft's pose to `to`, in parts where it is far (`count_substeps`), and solves them there
/// over `dt` seconds. `planes`, `walls` and `start` as in `step`.
SolvedSpines solve_spines(Tuft& tuft, const Pose& to, std::span<const ContactPlane> planes,
                          std::span<const ContactPlane> walls, double dt, StepStart* start);

}  // namespace tuft::brush
