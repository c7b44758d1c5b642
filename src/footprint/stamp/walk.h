#pragma once

#include "atlas/texels/cluster_graph.h"
#include "footprint/stamp/plan_scratch.h"
#include "footprint/stamp/stamp.h"

/// \file
/// Search over the texel clusters from the contact point of a stamp: the clusters connected to it within the
/// footprint, and their positions in its tangent plane. Called by `plan_stamp`.
namespace tuft::footprint {

/// Factor on a cluster's radius: the log map stretches it slightly.
inline constexpr float kClusterSlack = 1.1f;

/// Extent of a stamp.
struct Reach {
    Vec3f origin{0}, normal{0};  ///< metres, unit, world; of the stamp's frame
    float radius = 0;            ///< metres, motion included
    Vec2f lo{0}, hi{0};          ///< of the picture, motion included, metres
};

/// Start of the search.
struct Start {
    std::uint32_t triangle = kNone;  ///< of the mesh, under the contact point
    Frame frame;                     ///< world, tangent to the surface, origin at the contact point
    std::uint32_t cluster = kNone;   ///< under the contact point
    Vec2f place{0};                  ///< metres, of its centre in `frame`
    Vec2f turn{1, 0};                ///< cosine and sine of the rotation of its frame there
};

/// Returns the extent of a stamp, and the start of its search from the texel under its contact point: in the tangent
/// plane of the surface itself, since the stamp's normal may be a mean over a crease.
Reach reach_of(const Footprint& footprint, const Motion& motion);
Start start_of(const Surface& surface, const Footprint& footprint, const atlas::TexelRef& contact);

/// Returns the cluster of a texel.
std::uint32_t cluster_of(const atlas::TexelMap& texels, const atlas::TexelRef& texel);

/// Dijkstra search over the clusters by path length from the stamp's origin, along straightest paths. Stores the
/// clusters that the picture reaches in scratch.reached, ascending, and the positions of all visited ones in
/// scratch.nodes. Returns the number of clusters without a straight path over their neighbours: the occluded ones,
/// where the surface folds. Cost: 0.2 µs a cluster.
std::size_t walk_clusters(const atlas::ClusterGraph& graph, const Reach& reach, const Start& start,
                          PlanScratch& scratch);

/// The same over smooth surface: true when the log map of `frame` puts every visited cluster within `most_off` metres
/// of where the walk puts it, none is occluded or faces away, and no open border is near. False as soon as one is found
/// that does not fit; scratch.reached is incomplete then.
bool walk_smooth(const atlas::ClusterGraph& graph, const Reach& reach, const Start& start, const Frame& frame,
                 double most_off, PlanScratch& scratch);

/// States of a cluster, shared with occluded.h.
enum : std::uint8_t { kOpen, kFinal, kOutside };
/// Resets all nodes to open and unvisited.
void begin_walk(PlanScratch& scratch, std::size_t n_clusters);
/// Returns the node of a cluster; `place_start` also sets its position.
PlanScratch::Node& node_of(PlanScratch& scratch, std::uint32_t cluster);
PlanScratch::Node& place_start(PlanScratch& scratch, const Start& start);
/// Distance between where the log map of `frame` and the walk put a cluster's centre, metres.
double disagreement(const Frame& frame, const atlas::TexelCluster& cluster, const PlanScratch::Node& n);
/// `is_facing`: no texel of the cluster faces away from `normal`, nor from one that is one degree off.
bool is_facing(const atlas::TexelCluster& cluster, const Vec3f& normal);
/// `faces_away`: the cluster is never inked. `in_picture`: the cluster's disc intersects the picture.
bool faces_away(const Reach& reach, const atlas::TexelCluster& cluster);
bool in_picture(const Reach& reach, const atlas::TexelCluster& cluster, const PlanScratch::Node& n);

}  // namespace tuft::footprint
