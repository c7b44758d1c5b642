#pragma once

#include <optional>
#include <span>

#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"
#include "mesh/query/surface_query.h"

/// \file
/// Contact plane of a point, on the side of the surface where the ferrule is. Called by contact.h for every node,
/// and by `stroke` and `cli` to test poses.
namespace tuft::contact {

/// Position of a node relative to the surface.
struct NodeContact {
    brush::ContactPlane plane;       ///< touches the surface at `plane.origin`
    brush::ContactPlane wedge;       ///< the same, but with both faces' planes next to a sharp convex edge
    std::uint32_t triangle = kNone;  ///< under plane.origin; kNone: nothing within reach
    double height = 0;               ///< metres of the node over the plane, negative behind it
    Vec3 outside{0};                 ///< the node, or its projection in front of the surface
    double side = 1;                 ///< -1 where an open sheet is met from its back
};

/// A node and the path on which it comes to the surface.
struct NodeQuery {
    Vec3 node{0};                 ///< metres, world
    Vec3 from{0};                 ///< metres, world; a point outside
    double side = 1;              ///< of the surface at `from`; see `NodeContact::side`
    const Vec3* known = nullptr;  ///< any point of the surface: bounds the search and makes it faster; null: none
};

/// Cache of which triangles of one mesh have no sharp convex edge in reach of their points. Nodes come to the same
/// triangles again and again: it makes the search faster and changes no result.
class SmoothTriangles {
  public:
    bool has_no_edge(const mesh::TriangleMesh& mesh, std::uint32_t triangle);  ///< looks where it does not know

  private:
    static constexpr std::size_t kSlots = 1024;
    /// Twice the triangle, and one where an edge may be in reach; kNone: nothing.
    Recycled<std::uint32_t> slot_;
};

/// Distances of the search.
struct NodeContactOptions {
    double reach = 0.05;                ///< metres within which surfaces are looked for, > 0
    double lift = 2e-5;                 ///< metres, distance of `outside` from the surface, > 0
    SmoothTriangles* smooth = nullptr;  ///< of the mesh, or null
};

/// Returns the surface that a node meets when it comes from `from`. If a wall of any thickness lies between them,
/// the node is behind it, and the plane is that of the wall's front closest to the node. Otherwise it is that of the
/// closest point. Over a convex edge the normal turns smoothly from one face to the other.
NodeContact find_node_contact(const mesh::SurfaceQuery& surface, const NodeQuery& query,
                              const NodeContactOptions& options);

/// What an earlier search found for a chain. Each may be empty.
struct KnownContacts {
    std::span<const NodeContact> contacts;  ///< of the same nodes a little before
    std::span<const Vec3> nodes;            ///< metres, where the nodes of `contacts` were; none: unknown
    double still = 0;                       ///< metres: a node that moved no more keeps its plane, but beside an edge
};

/// Returns the contacts of a chain of nodes (tip first, root last, like the tuft's). Each is found from the previous
/// one, from the root outwards. Nodes farther than `near` metres from any surface share the last plane found; their
/// height over it is at most their distance from the surface. `known` makes the search faster. A node that keeps its
/// plane is off it by up to twice `known.still`.
Recycled<NodeContact> find_chain_contacts(const mesh::SurfaceQuery& surface, const NodeContact& root,
                                          std::span<const Vec3> nodes, double near, const NodeContactOptions& options,
                                          const KnownContacts& known = {});

/// Returns a point outside the object for a tuft at `root` whose handle points along `up`. It is the root, or,
/// inside a closed object, the exit point of the handle.
Vec3 find_outside_point(const mesh::SurfaceQuery& surface, const Vec3& root, const Vec3& up,
                        const NodeContactOptions& options);

/// Returns the distance, metres, from a point inside a closed body to its surface. Returns 0 outside, and on both
/// sides of an open sheet. A point is inside when the first hits in all six axis directions are back faces. Cost:
/// six rays.
double depth_inside(const mesh::SurfaceQuery& surface, const Vec3& p);

}  // namespace tuft::contact
