#pragma once

#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// \file
/// Graph of texel clusters: their adjacency on the surface, across charts and seams, and the relation of their
/// tangent frames. `footprint` searches it for every stamp.
namespace tuft::atlas {

/// A cluster: connected texels of one chart in one tile (a quarter of it where it bends), with
/// normals within 35° of a seed. Its frame sits at one of its own texels.
struct TexelCluster {
    Vec3f centre{0};         ///< metres, a texel near the middle
    Vec3f normal{0, 0, 1};   ///< unit, of that texel
    Vec3f tangent{1, 0, 0};  ///< unit; the frame's b is normal × tangent
    float radius = 0;        ///< metres: no texel centre of the cluster is further from `centre`
    /// Metres: unit vectors out over the open borders of the mesh that the cluster lies on, times their lengths,
    /// summed.
    Vec3f outward{0};
    float cone_cos = 1;                        ///< smallest dot product of a texel's normal with `normal`
    std::uint32_t slot = kNone;                ///< tile, in the order of `TexelMap::tiles`
    std::uint32_t chart = 0;                   ///< of the atlas
    std::uint8_t index = 0;                    ///< as in `TexelTile::cluster`
    std::uint8_t centre_texel = 0;             ///< texel of the tile at `centre`
    std::uint8_t first_row = 0, last_row = 0;  ///< rows of the tile it lies in, inclusive
};

/// Centre, tangent, b and normal of a cluster.
Frame frame_of(const TexelCluster& cluster);

/// Edge from cluster i to cluster `to` (j). A point x_j in j's frame is hop + R x_j in i's frame with R = [[c, −s],
/// [s, c]]: both are unfolded over their common border. The edge j → i holds the inverse motion.
struct ClusterEdge {
    std::uint32_t to = kNone;    ///< j
    float hop_u = 0, hop_v = 0;  ///< metres, in i's frame
    float c = 1, s = 0;          ///< unit, of R
};

/// Clusters of a texel map and the edges between neighbours.
struct ClusterGraph {
    std::vector<TexelCluster> clusters;        ///< slot by slot
    std::vector<std::uint32_t> cluster_start;  ///< [n_slots + 1]; cluster k of slot s is cluster_start[s] + k
    std::vector<std::uint32_t> edge_start;     ///< [n_clusters + 1]
    std::vector<ClusterEdge> edges;            ///< sorted by `to` within a cluster

    std::size_t n_clusters() const { return clusters.size(); }
};

/// Returns the clusters of a texel map and their edges: 8-neighbour texels inside a chart that are connected on the
/// surface, and texels on both sides of every mesh edge along which charts meet. Cost: about 0.5 s and 10 MB at
/// 4096². The same bits for any number of threads.
ClusterGraph build_cluster_graph(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                                 const ProgressFn& progress = {});

/// Returns the texel of a point of the mesh: the covered texel nearest in space among those near the point's
/// position in the atlas. Where the triangle and its surroundings are too thin to contain any, it is taken among
/// those near its neighbours' positions.
TexelRef texel_at(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, std::uint32_t triangle,
                  const Vec3& position);

}  // namespace tuft::atlas
