#pragma once

#include <memory>
#include <vector>

#include "brush/papers/spine_model.h"
#include "brush/papers/truss_dynamics.h"
#include "brush/papers/truss_skin.h"

/// \file
/// Brush model `truss` of [Baxter2001] (DAB): particles, springs and a subdivision skin. The
/// parts are truss_dynamics.h, truss_skin.h and truss_force.h.
///
/// A step moves the base with the handle, in short steps of at most M/Σk, Σk the springs at a point, and at most 400;
/// after each the points follow by first-order dynamics and are brought onto the surface. At the end springs are
/// contracted that are more than 5 % long. The pieces of the hand's motion are straight [X].
///
/// A round pressed straight down is unstable: it buckles sideways where the load exceeds 2 k ρ²/ℓ (ρ ≪ ℓ). It is nudged
/// by 1e-3 lengths against the hand's last motion, or to the ferrule's x [X]. Then its point trails √(L² − (L − z)²)
/// behind the axis at depth z.
///
/// The sections are cuts of the skin: across the hair, and near the ferrule parallel to its mouth. The skin shears with
/// the point, so they are as the head was made but for the lean: a b is not kept. Hair touches near the point alone.
///
/// `force` is the law of truss_force.h with the depth of the undeformed point: k1 = B0/L² [X], k2 = 40 k1 and
/// k_t = 1 s/m · k1, the ratios of MODEL's defaults [X]. Friction is −k_t v_t (4.4, the sign is missing in print [R]),
/// at most μ times the normal force [X]. The bending moments are those of the springs' force on the points.
namespace tuft::brush {

/// Returns the model of a round: one pyramid, straight at `Pose{}`. Cost of a step: 30 µs; a filbert 80 µs.
std::unique_ptr<SpineModel> make_truss_model(const Preset& preset);

/// Returns the model of a head of another shape with the hair of `preset`: its length, stiffness and friction. The skin
/// tapers in thickness as `preset` does in radius, and keeps its width.
std::unique_ptr<SpineModel> make_truss_model(const Preset& preset, truss::Kind kind, double width, double thickness);

}  // namespace tuft::brush
