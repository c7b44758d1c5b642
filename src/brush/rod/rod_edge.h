#pragma once

#include "brush/rod/rod_energy.h"

/// \file
/// Hair over a convex edge, and how a potential of a place on the hair adds to the nodes. Internal to the rod solver.
namespace tuft::brush::rod {

/// Adds curvature · f(k, l) to the second derivatives over nodes k and l of a stencil.
template <class F>
void add_curvature(const Stencil& at, const Sym3& curvature, Evaluation& out, const F& f) {
    for (int k = 0; k < at.count; ++k) out.curvature[at.first + k] += f(k, k) * curvature;
    for (int k = 0; k + 1 < at.count; ++k) out.coupling[at.first + k] += f(k, k + 1) * curvature;
    if (at.count > 2) out.across[at.first] += f(0, 2) * curvature;
}

inline void add_slope(const Stencil& at, const double* w, const Vec3& slope, Evaluation& out) {
    for (int k = 0; k < at.count; ++k) out.slope[at.first + k] += w[k] * slope;
}

/// Adds the derivatives of a potential of the place `at` over that place.
inline void add_potential(const Stencil& at, const Vec3& slope, const Sym3& curvature, Evaluation& out) {
    add_slope(at, at.w, slope, out);
    add_curvature(at, curvature, out, [&](int k, int l) { return at.w[k] * at.w[l]; });
}

inline bool over_edge(const Frozen& frozen, int p) {
    return frozen.crease[p].share > 0 && frozen.crease[p].convex && !frozen.law->hard;
}

/// Whether no piece of contact point p, which lies at x, can touch the edge or its wet film.
bool is_clear_of_edge(const Frozen& frozen, int p, const Vec3& x);

/// Adds the pieces of contact point p and returns their potential. Each piece of compliance k shortens by s along
/// itself: it stands where E(s) = s²/(2 k) + contact(r − z(x + s i)) is stationary, i the direction to the root and s
/// the largest such, where hair that comes from its root meets the surface. Without `derivatives` `out` does not
/// change.
double add_hair_at_edge(const Frozen& frozen, int p, bool derivatives, Evaluation& out);

/// Returns the mean plane that the pieces of contact point p meet, by their forces; `here` where none presses.
Obstacle mean_plane_at_edge(const Frozen& frozen, int p, const Recycled<Vec3>& node, const Obstacle& here);

}  // namespace tuft::brush::rod
