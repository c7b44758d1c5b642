#pragma once

#include <span>
#include <vector>

#include "brush/rod/rod_energy.h"

/// Inside of the rod solver: where contact points lie and what each of them meets.
namespace tuft::brush::rod {

/// Where hair is a curve for its contact: where points lie between the nodes.
inline bool rounded(const Law& law) {
    return law.points_per_segment > 2 && !law.hard;
}

/// The place at share s of segment j. Rounded: on the curve that runs from middle to middle of the segments along
/// parabolas with the nodes as their control points, so that the bend of a joint is spread evenly over the length of
/// hair that the joint stands for; straight outside the first and the last middle (quadratic B-spline).
Stencil stencil_at(const Rod& rod, bool round, int j, double s);

/// The nodes' own places on the rounded hair. [n+1]
std::vector<Vec3> curve_nodes(const Rod& rod, const std::vector<Vec3>& node);

/// Planes and radii of the contact points, interpolated between those of the nodes; over creases,
/// where a node has two planes or neighbours' planes part, both. `obstacles`: [n+1], or none;
/// `node`: [n+1], where the nodes are. Fills place, stencil, crease, weight and give of `frozen`, whose rod and law
/// are set. `fine`: [points], or none; those of walls come last, one for each.
void lay_points(std::span<const Obstacle> obstacles, const std::vector<Vec3>& node, Frozen& frozen,
                std::vector<Obstacle>& fine, std::span<const Wall> walls = {});

}  // namespace tuft::brush::rod
