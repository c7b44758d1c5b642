#pragma once

#include "atlas/texels/cluster_graph.h"
#include "footprint/stamp/stamp.h"

/// The walk over the clusters of the surface from the point that a stamp touches: which of them
/// hang together with it within the footprint, and where they lie in its tangent plane.
namespace tuft::footprint {

/// Of a cluster's radius: the log map stretches it a little.
inline constexpr float kPieceSlack = 1.1f;

/// What the walk needs to know of a stamp.
struct Reach {
    Vec3f origin{0}, normal{0};
    float radius = 0;    ///< metres, motion included
    Vec2f lo{0}, hi{0};  ///< of the picture, motion included, metres
};

/// Where the walk starts.
struct Start {
    std::uint32_t cluster = kNone;
    Vec2f place{0};    ///< metres, of its centre in the stamp's plane
    Vec2f turn{1, 0};  ///< cosine and sine of the angle by which its frame stands turned there
};

/// Dijkstra over the clusters by the length of the straightest ways from the stamp's origin. Leaves
/// those that the picture reaches in scratch.reached, in order of their numbers, and the places of
/// all visited in scratch.nodes. Returns to how many of them no straight way over their neighbours leads: where the
/// surface folds. Cost: 0.2 µs a cluster.
std::size_t walk_clusters(const atlas::ClusterGraph& graph, const Reach& reach, const Start& start,
                          PlanScratch& scratch);

/// What the walk over clusters and that over folds (occluded.h) have in common: states of a cluster,
enum : std::uint8_t { kOpen, kFinal, kOutside };
/// all nodes open again, those of no cluster visited yet,
void begin_walk(PlanScratch& scratch, std::size_t n_clusters);
/// a cluster's node,
PlanScratch::Node& node_of(PlanScratch& scratch, std::uint32_t cluster);
PlanScratch::Node& place_start(PlanScratch& scratch, const Start& start);
/// and what is never inked, or lies beside the picture: the cluster's disc has no point in common
/// with it.
bool faces_away(const Reach& reach, const atlas::TexelCluster& cluster);
bool in_picture(const Reach& reach, const atlas::TexelCluster& cluster, const PlanScratch::Node& n);

}  // namespace tuft::footprint
