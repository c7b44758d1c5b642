#pragma once

#include <span>
#include <vector>

#include "brush/rod_energy.h"

/// Inside of the rod solver: where contact points lie and what each of them meets.
namespace tuft::brush::rod {

inline Vec3 point_at(const PointPlace& at, const std::vector<Vec3>& node) {
    return (1 - at.s) * node[at.node] + at.s * node[at.node + 1];
}

/// Planes and radii of the contact points, interpolated between those of the nodes; over creases,
/// where a node has two planes or neighbours' planes part, both. `obstacles`: [n+1], or none;
/// `node`: [n+1], where the nodes are. Fills place, crease, weight and give of `frozen`, whose rod and law
/// are set. `fine`: [points], or none.
void lay_points(std::span<const Obstacle> obstacles, const std::vector<Vec3>& node, Frozen& frozen,
                std::vector<Obstacle>& fine);

}  // namespace tuft::brush::rod
