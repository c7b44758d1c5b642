#pragma once

#include <array>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Sweeping ellipse, inner stress, distension and recovery of a hair macro. Lengths are in units of the rest radius
/// r(t) of the tuft. Called by hair_macro.cpp.
///
/// Source: [Xu2009], 5.4.1.2 and 5.4.2. [p] is printed there, [R] is restored, [X] is ours.
///
/// A point of the profile is x = L ν cos w, y = S ν sin w, 0 ≤ ν ≤ 1                 (5.1) [p].
/// Its stress is tan(k1 q) for q ≤ 0 and tan(k2 q) else, kept off ±π/2              (5.5) [p],
/// q = 1 − R_u(w + τ)/R_d(w), R² = L² cos² w + S² sin² w, u undeformed, d deformed      [R].
/// The printed q = 1 − ν_u/ν_d with ν_u = ν_d is 0 everywhere; R are the radii themselves.
/// Positive stress acts inwards. It depends on w alone, so groups of points are sectors.
namespace tuft::brush::macro {

/// Semi-axes of a profile along its own two axes.
struct Ellipse {
    double l = 1, s = 1;
};

/// Semi-axis normal to the surface of a profile that is `z` above it, with the other axis level (5.4): the area below
/// the surface is least at constant L S. Least area asks for S ≤ z [R]; it is unbounded as z → 0, so S ≥ `least` [X]:
///
///     S ← min(S, max(z, least)).
double pressed_axis(double s, double z, double least);

/// Constants of the inner stress.
struct StressLaw {
    double compressed = 1;   ///< k1, where the profile became narrower [X]
    double stretched = 1;    ///< k2, where it became wider [X]
    double sensitivity = 2;  ///< k3 of (5.8) [X]
    double most = 10;        ///< largest |tan|: the printed ±π/2 are poles [X]
};

/// Stress (5.5) of a point with R_u/R_d = `ratio`.
double point_stress(double ratio, const StressLaw& law);

inline constexpr int kTurns = 8;  ///< in the half turn after which a profile is the same

/// Mean stress (1/2π) ∮ ρ dw of a profile (5.6) with τ = π turn/kTurns; the same with or without Jacobian [R].
double mean_stress(const Ellipse& undeformed, const Ellipse& deformed, int turn, const StressLaw& law);

/// Turn and mean stress, where its absolute value is least (5.6); the bars are lost in print, the text has them [R].
/// The turn is 0 … kTurns/2 [X]: τ and −τ have the same mean, and of a round undeformed profile all have.
struct TurnedStress {
    int turn = 0;
    double stress = 0;
};
TurnedStress least_stress(const Ellipse& undeformed, const Ellipse& deformed, const StressLaw& law);

/// β = ½ − arctan(k3 ρ)/π (5.8), in (0, 1) [p].
double distensibility(double stress, const StressLaw& law);

/// Thresholds of the recovery.
struct RecoveryLaw {
    double elastic = 0.2;  ///< thre_ela [X]
    double rigid = 2;      ///< thre_rig [X]
    double time = 0.04;    ///< s, in which the printed extent is reached [X]
};

/// Extent x of the recovery (5.10): 1 up to the elastic threshold, 0 from the rigid one on, linear between [p].
double recovery_extent(double stress, const RecoveryLaw& law);
/// The same over `dt` seconds, 1 − (1 − x)^{dt/time}: two steps recover what one of their sum does [X].
double recovery_extent(double stress, const RecoveryLaw& law, double dt);

inline constexpr int kRays = 64;  ///< directions w_k = 2π (k + ½)/kRays of a profile
using Rays = std::array<bool, kRays>;

/// Connected points of a profile whose stress exceeds a threshold.
struct StressGroup {
    Rays rays{};
    double stress = 0;  ///< mean

    double share() const;  ///< of the profile's area
};

/// Returns the groups above `threshold`, without those of less than `least_share` of the area: neighbouring hair
/// attracts [p], by how much is [X]. Points correspond with τ = 0: of τ and −τ, which have the same mean, neither would
/// be that of the mirror image [X].
std::vector<StressGroup> stress_groups(const Ellipse& undeformed, const Ellipse& deformed, double threshold,
                                       double least_share, const StressLaw& law);

/// Ellipse that takes the place of a group of points after a split.
struct GroupEllipse {
    Vec2 centre{0};    ///< centroid of the group, along the parent's axes
    Ellipse axes;      ///< l s = share L S: the group's area
    double turn = 0;   ///< of l, from the parent's l; within π/4
    double share = 0;  ///< of the parent's area
};

/// Returns the ellipse of the rays: centre, area, ratio of the bounding box along the principal axis, and that axis
/// [p]. l is the axis nearer to the parent's l, so that the deformed and the undeformed ellipse correspond [X].
GroupEllipse group_ellipse(const Rays& rays, const Ellipse& parent);

}  // namespace tuft::brush::macro
