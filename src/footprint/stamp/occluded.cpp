#include "footprint/stamp/occluded.h"

#include <algorithm>
#include <cmath>

#include "atlas/texels/log_map.h"
#include "atlas/texels/seams.h"
#include "mesh/query/exact_geodesics.h"

namespace tuft::footprint {
namespace {

constexpr double kFewOccluded = 0.01;         // of the clusters: fewer are left where the walk placed them
constexpr double kBeyond = 1.1;               // of the reach: clusters that begin there
constexpr std::size_t kMostWindows = 40'000;  // some 10 ms
constexpr double kMerge = 0.005;              // texels; sums of a hundred move a path by half of one at most
constexpr double kBeside = 1e-3;              // of a triangle: rounding of positions in the atlas

/// Finds the triangle of each cluster centre. Of the triangles that contain the centre in the atlas, up to rounding,
/// the one that maps it nearest to its position in space counts.
class CentreLocator {
  public:
    CentreLocator(const Surface& surface, TriangleCache& triangle_cache) : surface_(surface), entries_(triangle_cache) {
        triangle_cache.clear();
    }

    void add_triangle(std::uint32_t t) {
        const Vec2 a = atlas::corner_texels(surface_.atlas, t, 0);
        const Vec2 b = atlas::corner_texels(surface_.atlas, t, 1) - a;
        const Vec2 c = atlas::corner_texels(surface_.atlas, t, 2) - a;
        const double det = b.x * c.y - b.y * c.x;
        if (!std::isfinite(a.x + a.y) || !(std::abs(det) > 0) || !std::isfinite(1 / det)) return;
        const Vec2 lo = a + glm::min(Vec2{0}, glm::min(b, c));
        const Vec2 hi = a + glm::max(Vec2{0}, glm::max(b, c));
        const std::int64_t x1 = tile(hi.x), y1 = tile(hi.y);
        for (std::int64_t y = tile(lo.y); y <= y1; ++y)
            for (std::int64_t x = tile(lo.x); x <= x1; ++x) {
                const std::uint32_t slot =
                    surface_.texels.slot_of_tile[static_cast<std::size_t>(y * surface_.texels.tiles_per_side + x)];
                if (slot == kNone) continue;
                const auto& first = surface_.texels.cluster_start;
                for (std::uint32_t i = first[slot]; i < first[slot + 1]; ++i) {
                    const atlas::TexelCluster& cluster = surface_.clusters.clusters[i];
                    if (cluster.chart != surface_.atlas.triangle_chart[t]) continue;
                    const Vec2 d = Vec2(double(x) * atlas::kTile + cluster.centre_texel % atlas::kTile + 0.5,
                                        double(y) * atlas::kTile + cluster.centre_texel / atlas::kTile + 0.5) -
                                   a;
                    insert(i, t, (d.x * c.y - d.y * c.x) / det, (b.x * d.y - b.y * d.x) / det);
                }
            }
    }

  private:
    std::int64_t tile(double texels) const {
        const auto last = static_cast<std::int64_t>(surface_.texels.tiles_per_side) - 1;
        return std::clamp(static_cast<std::int64_t>(std::floor(texels / atlas::kTile)), std::int64_t{0}, last);
    }

    void insert(std::uint32_t cluster, std::uint32_t t, double w1, double w2) {
        const double w0 = 1 - w1 - w2;
        if (std::min({w0, w1, w2}) < -kBeside) return;
        const Vec3 off = w0 * surface_.mesh.position(t, 0) + w1 * surface_.mesh.position(t, 1) +
                         w2 * surface_.mesh.position(t, 2) - Vec3(surface_.clusters.clusters[cluster].centre);
        entries_.insert(cluster, t, glm::dot(off, off));
    }

    const Surface& surface_;
    TriangleCache& entries_;
};

struct OccludedClusters {
    const mesh::TriangleMesh& mesh;
    const mesh::ExactGeodesics& geodesics;
    const Frame& from;
    Vec3 normal;  ///< of the triangle at its origin

    bool place(const atlas::TexelCluster& cluster, std::uint32_t triangle, PlanScratch::Node& n) const {
        if (triangle == kNone) return false;
        const mesh::ExactGeodesics::Geodesic path = geodesics.to(triangle, Vec3(cluster.centre));
        if (!std::isfinite(path.length)) return false;
        const Vec2 leaves = atlas::transport_direction(from, path.start_direction, normal);
        const Vec2 arrives =
            atlas::transport_direction(atlas::frame_of(cluster), path.end_direction, face_normal(mesh, triangle));
        n.u = static_cast<float>(path.length * leaves.x);
        n.v = static_cast<float>(path.length * leaves.y);
        n.c = static_cast<float>(glm::dot(leaves, arrives));
        n.s = static_cast<float>(arrives.x * leaves.y - arrives.y * leaves.x);
        return true;
    }
};

}  // namespace

void TriangleCache::clear() {
    numbers_.clear();
    entries_.clear();
}

void TriangleCache::insert(std::uint32_t cluster, std::uint32_t triangle, double off2) {
    const auto [entry, is_new] = numbers_.number(cluster);
    if (is_new)
        entries_.push_back({triangle, off2});
    else if (off2 < entries_[entry].off2)
        entries_[entry] = {triangle, off2};
}

void resolve_occluded(const Surface& surface, const Reach& reach, const Start& start, std::size_t occluded,
                      PlanScratch& scratch) {
    const auto n_clusters = static_cast<double>(scratch.reached.size());
    if (occluded == 0 || static_cast<double>(occluded) < kFewOccluded * n_clusters) return;
    mesh::ExactGeodesics& geodesics = scratch.geodesics;
    const double radius = kBeyond * static_cast<double>(reach.radius);
    if (!geodesics.spread(surface.mesh, start.triangle, start.frame.origin, radius,
                          {kMostWindows, kMerge * surface.texels.texel_size}))
        return;
    CentreLocator locator(surface, scratch.triangle_cache);
    for (std::size_t i = 0; i < geodesics.n_faces(); ++i) locator.add_triangle(geodesics.triangle(i));
    const OccludedClusters occluded_clusters{surface.mesh, geodesics, start.frame,
                                             face_normal(surface.mesh, start.triangle)};
    const atlas::ClusterGraph& graph = surface.clusters;
    begin_walk(scratch, graph.n_clusters());
    std::vector<std::uint32_t> open{start.cluster};
    place_start(scratch, start).state = kFinal;
    scratch.reached.clear();
    for (std::size_t i = 0; i < open.size(); ++i) {
        const std::uint32_t index = open[i];
        const atlas::TexelCluster& cluster = graph.clusters[index];
        PlanScratch::Node& n = node_of(scratch, index);
        const bool placed = occluded_clusters.place(cluster, scratch.triangle_cache.of(index), n);
        const float distance = std::sqrt(n.u * n.u + n.v * n.v);
        if (index != start.cluster &&
            (!placed || distance - kClusterSlack * cluster.radius > reach.radius || faces_away(reach, cluster)))
            continue;
        if (in_picture(reach, cluster, n)) scratch.reached.push_back(index);
        for (std::uint32_t k = graph.edge_start[index]; k < graph.edge_start[index + 1]; ++k) {
            PlanScratch::Node& other = node_of(scratch, graph.edges[k].to);
            if (other.state != kOpen) continue;
            other.state = kFinal;
            open.push_back(graph.edges[k].to);
        }
    }
    std::sort(scratch.reached.begin(), scratch.reached.end());
}

}  // namespace tuft::footprint
