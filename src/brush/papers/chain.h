#pragma once

#include <memory>

#include "brush/papers/spine_model.h"

/// \file
/// The brush model of [Chu2002] with the additions of [VanLaerhoven2007]: a kinematic chain of
/// least energy with friction as energy, and lateral nodes beside it.
///
/// Per step: the root goes to the pose, bends are kept. Nodes below the surface get constraints, and the points where
/// they touched by interpolation between their last and their carried place. Then the parts of this folder:
///
/// 1. Spine (chain_solver.h): bends w of least energy, z >= r_sp. r_sp = kEffectiveRadius · minor radius of the last
///    step [p: "fractions"; ½ X], 0 at the tip, which ends in a point [X]. N of the friction are the constraint forces
///    of the last step [Van Laerhoven: "a constant, approximated at each time step"].
/// 2. Plasticity: ρ = min(|w'|, α) w'/|w'| [sign R], α = plastic_share of the bend that hair lying flat has on the
/// mean,
///    0.3 of it dry [X]. ρ follows the last step, so a held bend relaxes step by step, as in print: a bend below α ends
///    without force.
/// 3. Pores: p·Δx_tip <= l_p, p the projected tip, l_p = l_0 + z cot α_tip [R: the path to touch], l_0 = 0.05 mm [X],
///    while the tip points down and slants more than 1° [X].
/// 4. Lateral nodes (chain_lateral.h) of every second node: s(θ) = σ r k/k_ref with k the curvature there and k_ref
///    that of hair bent evenly from upright to flat [linear p; σ = 0.5 X]; springs 0.03 k_c, dry 0.7 of it [X]. Their
///    normal force is a fraction of the spine node's [p; ¼ X]. The others are interpolated.
/// 5. Section: major radii d + r_l on both sides, minor radius c = 2 r² / (a + b + r_left + r_right); kept as one
///    ellipse of the mean major radius with its centre midway, the same area π r².
///
/// Two spines (`spines` 2) each have half of the hair, at the centroids of the two halves of the ferrule, and drive
/// one side of a lattice (lattice.h), which carries the sections. A flat and a filbert have two; the others are round
/// and have one.
///
/// B(ξ), μ, κ_f, C_η, plastic_share and k_c are the preset's. Energy: `lost` holds the friction and what the change of
/// bend costs; what ρ takes away between steps is in no term, so the balance with the hand's work is not kept.
namespace tuft::brush {

/// Constants of the kinematic chain.
struct ChainOptions {
    double exponent = 3;            ///< m [p]
    double change_weight = 0.2;     ///< of the energy of the change of bend per step [X]
    double effective_radius = 0.5;  ///< r_sp and r_l over the minor radius [X]
    double plastic_angle = 1;       ///< factor on α
    bool pores = true;
    int spines = 1;  ///< 1 or 2
};

/// Returns the model, straight at `Pose{}`. Cost of a step: 0.3–2 ms at 16 segments.
std::unique_ptr<SpineModel> make_chain_model(const Preset& preset, const ChainOptions& options = {});

}  // namespace tuft::brush
