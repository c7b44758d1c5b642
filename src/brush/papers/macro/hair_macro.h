#pragma once

#include <span>
#include <vector>

#include "brush/papers/macro/macro_skeleton.h"
#include "brush/papers/macro/macro_spline.h"
#include "brush/papers/macro/macro_stress.h"
#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"

/// \file
/// A hair macro: the least part of the tuft in the model of [Xu2009], ch. 5. An ellipse E(t) with semi-axes
/// L(t), S(t), turned by θ(t), is swept along a skeleton K(t) and stays normal to it; t is 0 at the tip, 1 at the root
/// (5.1), (5.2) [p]. macro_model.cpp moves macros.
///
/// K and θ are splines of four control points [p]. So is the widening λ(t); with the rest radius r(t), the growth g of
/// the whole macro and its share c of the hair,
///
///     L = g r λ,   S = g r c/λ,   L S = c (g r)²                                               [R]:
///
/// the paper derives S from L by the constant product, and 5.4.3 stores four control points of the deformation of L.
/// g = β/½ is the product of all ratios β2/β1 of (5.9) from a macro without stress, β = ½, on.
namespace tuft::brush::macro {

/// Constants of all macros of a tuft.
struct MacroLaw {
    double rigidity = 0.5;     ///< r of (5.3a), called rfc: the preset's hardness [X]
    double flattest = 3;       ///< L grows to this multiple of its rest value at most, by (5.4) [X]
    double split_dry = 0.7;    ///< ρ_max of dry hair: L about 2.6 times its rest value [X]
    double split_wet = 2;      ///< ρ_max of wet hair, never reached at rest growth [X]
    double least_share = 0.1;  ///< of the tuft: smaller groups do not split off [X]
    StressLaw stress;
    RecoveryLaw recovery;

    double split_threshold(double wetness) const { return split_dry + wetness * (split_wet - split_dry); }
};

/// Nodes along the hair, from tip to root.
struct HairRow {
    double length = 0;           ///< metres
    std::vector<double> t;       ///< [n+1] parameter: arc length from the tip over the length
    std::vector<double> weight;  ///< [n+1] tributary part of t; sums to 1
    std::vector<double> radius;  ///< [n+1] metres, r(t)
};

/// Return the nodes along the hair of a preset, and the constants of its macro.
HairRow make_hair_row(const Preset& preset);
MacroLaw make_macro_law(const Preset& preset);

/// Undeformed macro H_u, in the ferrule's frame.
struct MacroRest {
    CurveSpline skeleton{};  ///< metres
    Vec2 offset{0};          ///< of the centre from the tuft's, in units of r
    Ellipse axes;            ///< in units of r; l s = share
    double turn = 0;         ///< θ, of l from the ferrule's x
    double share = 1;        ///< c, of the tuft's hair

    bool round() const { return axes.l == axes.s; }
};

/// A hair macro and its state.
struct HairMacro {
    MacroRest rest;
    CurveSpline skeleton{};       ///< K, metres, world
    Spline widening{1, 1, 1, 1};  ///< λ
    Spline turn{};                ///< θ, radians, of L from the ferrule's x transported along K
    double growth = 1;            ///< g
    double stress = 0;            ///< ρ(H), (5.7)
    bool touching = false;        ///< K_o of the last collision was below the surface
};

/// Returns the undeformed round tuft at `pose`.
HairMacro make_macro(const HairRow& row, const Pose& pose);

/// Returns the macro at rest at `pose`, as it was made.
HairMacro at_rest(const HairMacro& macro, const Pose& pose);

/// Returns K(t) at the nodes, metres, world. [n+1]
std::vector<Vec3> nodes_of(const CurveSpline& skeleton, const HairRow& row);

/// Moves the macro rigidly with the ferrule.
void move_rigidly(HairMacro& macro, const Pose& from, const Pose& to);

/// Recovery from deformation over dt: H ← (1 − x) H + x H_u (5.10). θ of a round macro stays: a circle has none.
void recover(HairMacro& macro, const Pose& pose, const MacroLaw& law, double dt);

/// What a macro meets in one step.
struct Collision {
    Pose pose;
    std::span<const ContactPlane> planes;  ///< one for all, one per node, or none
    Vec3 aside{1, 0, 0};                   ///< in which upright hair falls, world
    Vec3 push{0};                          ///< direction of the hand's motion over the surface, unit; or zero
    std::span<const Vec3> trunk = {};      ///< [n+1] metres, mean of all macros before it; or none
};

/// Bends the skeleton out of the surface (5.3), kinks it up, and flattens the ellipses (5.4). A macro that is nowhere
/// below the surface and whose ellipses do not reach it stays as it is. The friction that kinks needs high stress and a
/// hand that pushes the hair tip first [p]; the held fraction (1 − x) max(0, cos of push and hair) is [X].
void collide(HairMacro& macro, const HairRow& row, const MacroLaw& law, const Collision& collision);

/// Finds growth and stress that fit each other: g = 2 β(ρ(H(g))) by (5.7), (5.8), (5.9). The printed single change per
/// step does not converge; ρ rises with g, so the balance is unique [R].
void distend(HairMacro& macro, const HairRow& row, const MacroLaw& law);

/// Average inner stress ρ(H) = ∫₀¹ ρ(E(t)) dt (5.7) at the growth g. The turns τ are those of the macro without growth,
/// so that the stress has no steps [X].
double macro_stress(const HairMacro& macro, const HairRow& row, const MacroLaw& law, double growth);

/// Returns the sections, tip first, with a = L and b = S. Moments and pressures are 0. No centre but the root's is
/// below its plane.
Recycled<Section> macro_sections(const HairMacro& macro, const HairRow& row, const MacroLaw& law, const Pose& pose,
                                 std::span<const ContactPlane> planes);

/// Splits the macro at the group of points with the highest stress, if any exceeds `threshold` (5.4.2.3): the group and
/// what remains become macros of their own. Groups of equal stress split together, so that a mirror image splits alike
/// [X]. The sectors are those of the profile with the highest stress; all other profiles are divided along the same w
/// [X]. Returns the parts along the parent's L, or nothing when it does not split.
std::vector<HairMacro> split(const HairMacro& macro, const HairRow& row, const MacroLaw& law, double threshold,
                             const Collision& collision);

}  // namespace tuft::brush::macro
