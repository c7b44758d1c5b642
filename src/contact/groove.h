#pragma once

#include "contact/node_contact.h"

/// \file
/// Both walls of a groove. A node between two walls has the plane of the nearer one; pressed by that alone it goes
/// through the other, and at the next sample the other is the nearer one. Called by contact.h.
namespace tuft::contact {

/// What a node meets: the surface nearest to it, or both walls that it lies between. Which wall is `own` stays from
/// sample to sample and agrees between neighbouring nodes, whichever is nearer.
struct NodeWalls {
    NodeContact own;
    NodeContact across;  ///< `triangle` is kNone where there is none

    bool in_groove() const { return across.triangle != kNone; }
    /// Returns the height of a point over the nearer one, metres.
    double height(const Vec3& p) const;
};

/// Returns whether two contacts of one node are of the walls of a groove of less than 73°: none touches the surface
/// behind the other's plane.
bool face_each_other(const NodeContact& a, const NodeContact& b);

/// Returns the walls that a node lies between. `nearest`: its contact with the nearest surface, returned alone where no
/// other wall is near. `known`: the walls that it or its neighbour lay between a little before. Metres. Cost: one or
/// two searches for a closest point, within some millimetres.
NodeWalls find_walls(const mesh::SurfaceQuery& surface, const Vec3& node, const NodeContact& nearest, double radius,
                     const NodeWalls& known, const NodeContactOptions& options);

/// Nodes of chains, such as spines, one chain after the other, each tip first.
struct NodeChains {
    std::span<const std::size_t> lengths;  ///< [chains] nodes of each
    std::span<const Vec3> nodes;           ///< metres; those after the chains lie in no groove
    std::span<const NodeContact> nearest;  ///< [nodes] the nearest surfaces
    std::span<const double> radii;         ///< [nodes of the chains] metres
    std::span<const NodeWalls> known;  ///< [nodes of the chains] their walls a little before; none: no groove is found
};

/// Returns the walls of all nodes. A node without known walls looks between those of its neighbours in its chain, and
/// neighbours in one groove have the same own wall. [nodes]
Recycled<NodeWalls> find_chain_walls(const mesh::SurfaceQuery& surface, const NodeChains& chains,
                                     const NodeContactOptions& options);

/// Returns whether a node is the last one of its chain, its root, or of none. `lengths`: of `NodeChains`.
bool is_root(std::span<const std::size_t> lengths, std::size_t node);

/// Returns the walls of a node that was bent on those of `before` and came to rest at `node`, where `nearest` is the
/// nearest surface. `inboard`: of the neighbour towards the root, or null.
NodeWalls update_walls(const NodeWalls& before, const NodeContact& nearest, const Vec3& node, double radius,
                       const NodeWalls* inboard);

}  // namespace tuft::contact
