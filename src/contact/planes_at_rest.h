#pragma once

#include <span>

#include "contact/groove.h"
#include "contact/node_contact.h"

/// \file
/// Whether the planes against which a tuft was bent are those where its nodes came to rest, and new ones where they are
/// not. Lengths in metres. Called by contact.cpp in each pass of a solve.
namespace tuft::contact {

/// Radii of the nodes of a tuft: the trunk's, and one for those of all branches beyond.
struct NodeRadii {
    std::span<const double> trunk;
    double root = 0;  ///< metres

    double at(std::size_t i) const { return i < trunk.size() ? trunk[i] : root; }
};

/// How far the planes of a solve are off where its nodes came to rest.
struct PlaneErrors {
    double worst = 0;            ///< metres
    Recycled<std::size_t> near;  ///< nodes near the surface, from the root
};

/// The nodes of a tuft where a solve left them, spine after spine, each tip first.
struct NodesAtRest {
    std::span<const Vec3> nodes;           ///< metres, world
    const Recycled<NodeContact>& found;    ///< the surface at them
    const NodeRadii& radii;                ///< of the tuft
    const Recycled<std::size_t>& lengths;  ///< nodes of each spine
};

/// Compares the planes of a solve with the surface at the nodes.
PlaneErrors find_plane_errors(const Recycled<NodeWalls>& walls, const NodesAtRest& rest);

/// Gives the nodes of `near` the walls that were found where they came to rest, from the root, which the walls of the
/// next ones agree with. `before`: the walls as they were.
void renew_walls(Recycled<NodeWalls>& walls, const Recycled<NodeWalls>& before, const Recycled<std::size_t>& near,
                 const NodesAtRest& rest);

}  // namespace tuft::contact
