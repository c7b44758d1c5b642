#pragma once

#include <memory>

#include "brush/papers/spine_model.h"

/// \file
/// Brush model `macro` of [Xu2009], ch. 5: hair macros swept by splines, in three layers: macro, cluster,
/// tuft. It is geometric: no forces are solved. The lower layers are hair_macro.h and macro_cluster.h.
///
/// A step carries the macros with the ferrule and lets them recover (5.10); then each
///     1. bends its skeleton out of the surface (5.3) and kinks it up,
///     2. turns and flattens its ellipses (5.4),
///     3. takes the growth that fits its average stress (5.5)–(5.9),
///     4. splits where the stress of a group of points is too high, the highest first.
/// The paper recovers last. Recovery towards the undeformed shape would put the hair below the surface again, so here
/// it comes before the next collision: the same cycle, shown at another place [X]. Split macros merge when the tuft is
/// straightened, the caress of the text [p]. Without calibration data the database of 5.4.3 changes nothing; it is left
/// out.
///
/// Forces are not in the paper. The model has the transverse stiffness of the preset and the bending of its skeleton
/// [X]:
///
///     p = c k_c ⟨r max(n_s, 0.1) − z⟩   force per length, n_s the sine of the lean, z the height over the surface
///     m = c B(ξ) κ                      bending moment, κ the curvature of K
///     F = Σ p Δs (n − μ v̂)              v̂ the hand's direction over the surface
///
/// With recovery complete (stress up to thre_ela) the shape depends on the pose and the hand's last direction alone.
/// Then upright hair pressed by d lies on the surface over about r d. Growth relieves stress: with the constants of
/// MacroLaw, which are guesses, that of a whole tuft stays below 0.1, so it neither takes a set nor kinks. Energies are
/// 0: the model has none.
namespace tuft::brush {

/// Returns the model of a round tuft, straight at `Pose{}`. Cost of a step: 80–300 µs, by the number of macros.
std::unique_ptr<SpineModel> make_macro_model(const Preset& preset);

}  // namespace tuft::brush
