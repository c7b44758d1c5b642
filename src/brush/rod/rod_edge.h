#pragma once

#include "brush/rod/rod_energy.h"

/// \file
/// Hair over a convex edge. Internal to the rod solver.
namespace tuft::brush::rod {

inline bool over_edge(const Frozen& frozen, int p) {
    return frozen.points.crease[p].share > 0 && frozen.points.crease[p].convex && !frozen.law->normal.hard;
}

/// Whether no piece of contact point p, which lies at x, can touch the edge or its wet film.
bool is_clear_of_edge(const Frozen& frozen, int p, const Vec3& x);

/// Adds the pieces of contact point p and returns their potential. A piece of compliance k shortens by s along itself,
/// the largest s at which E(s) = s²/(2 k) + contact(r − z(x + s i)) is stationary. i: direction to the root. Hair that
/// comes from its root meets the surface there first. Without `derivatives` `out` does not
/// change.
double add_hair_at_edge(const Frozen& frozen, int p, bool derivatives, Evaluation& out);

/// Returns the mean plane that the pieces of contact point p meet, by their forces; `here` where none presses.
Obstacle mean_plane_at_edge(const Frozen& frozen, int p, const Recycled<Vec3>& node, const Obstacle& here);

}  // namespace tuft::brush::rod
