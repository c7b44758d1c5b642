#pragma once

#include <memory>

#include "brush/papers/spine_model.h"
#include "brush/tuft/geometry_tuft.h"

/// \file
/// A sponge: open-cell foam on a single short spine, in place of hair. `make_tuft` makes it for presets with a modulus.
///
/// The foam is a foundation of columns along the ferrule's axis (Winkler 1867). A column of the undeformed foam that
/// would reach a depth δ below the surface along the axis is pressed by the strain ε = δ/H, H the foam's height:
///
///     σ(ε) = E* ε                                                   ε <= ε_D = 1 − 1.4 φ
///     σ(ε) = E* (ε_D + (1 − ε_D) ((1 − ε_D)/(1 − ε) − 1))           beyond: cells are shut
///     F = ∫ σ dA n,   volume lost = ∫ δ dA,
///
/// with φ the solid part ([Gibson1997], 5.3 and 5.15). A flat face of area A gives F = E* A d/H, a dome of
/// radius R gives E* π R d²/H (d much less than R). The form beyond ε_D is ours: it has no kink and no limit.
/// Layers of a column shrink by 1 − δ/h, h its own height; it does not bulge (Poisson's ratio of open cells is near 0
/// in large compression).
///
/// Across, the face sticks to the surface while the shear force G A s/H, G = E*/2, is below μ F, then it slides:
/// the layers lean by s.
///
/// The skin has open pores: spheres of a seeded grid of the material, uniform in diameter between the preset's two, as
/// many as leave the skin 45 % of its area [X]. Pore and unevenness are fixed to the material.
namespace tuft::brush {

/// Strain from which the cells of foam with the solid part `solid` are shut.
constexpr double densification_strain(double solid) {
    return 1 - 1.4 * solid;
}

/// σ(ε) over E*, 0 <= ε < 1, and its integral ∫ σ dε over E*.
double foam_stress(double solid, double strain);
double foam_energy(double solid, double strain);

/// Returns the body of a sponge: of the preset's geometry, or a cylinder with its face, rim and unevenness.
std::shared_ptr<const CarriedShape> make_foam(const Preset& preset, const Bundles& bundles);

/// Returns the model of a sponge with that body, at `Pose{}`. Its nodes are places of the face, not of an axis: node 0
/// in its middle, the next on a spiral round it, so that every part of the face meets its own plane; the last is the
/// mouth. Cost of a step:
/// about 0.2 µs a point of the body.
std::unique_ptr<SpineModel> make_foam_model(const Preset& preset, std::shared_ptr<const CarriedShape> body);

}  // namespace tuft::brush
