#pragma once

#include <span>

#include "brush/rod/rod_energy.h"
#include "core/system/recycled.h"

/// \file
/// Contact points of the rod: their positions and planes. Internal to the rod solver; `brush/tuft` uses the rounded
/// nodes.
namespace tuft::brush::rod {

/// Returns true when contact treats the hair as a curve: with points between the nodes and the soft law.
inline bool rounded(const Law& law) {
    return law.points_per_segment > 2 && !law.normal.hard;
}

/// Returns the position at parameter s of segment j. With `round` it lies on the quadratic B-spline with the nodes
/// as control points: parabolas from segment middle to segment middle, straight outside the first and the last
/// middle. A joint's bend is then spread evenly over the length of hair that the joint represents.
Stencil stencil_at(const Rod& rod, bool round, int j, double s);

/// Returns the nodes' positions on the rounded hair. [n+1]
Recycled<Vec3> curve_nodes(const Rod& rod, const Recycled<Vec3>& node);

/// Computes the contact points: planes and radii interpolated between those of the nodes. At a crease a node has
/// two planes, or neighbouring nodes have different ones; its points get both. `obstacles`: [n+1], or empty;
/// `node`: [n+1], node positions. Fills place, stencil, crease, weight and compliance of `frozen`, whose rod and law
/// are set. `fine`: [points], or empty; the last points are those of the walls, one each.
void compute_points(std::span<const Obstacle> obstacles, const Recycled<Vec3>& node, Frozen& frozen,
                    Recycled<Obstacle>& fine, std::span<const Wall> walls = {});

}  // namespace tuft::brush::rod
