#pragma once

#include <cstdint>
#include <limits>
#include <queue>
#include <span>
#include <vector>

#include "atlas/seams/half_edges.h"
#include "core/system/memory.h"

/// \file
/// Seam moves along shortest paths, with both charts remaining disks. Used by move_seams.h and straighten.h.
namespace tuft::atlas {

/// A chain of seam edges between two corners, and its replacement path. The same chart lies on the left of both.
struct SeamMove {
    std::vector<std::uint32_t> chain, path;  ///< half-edges
    float saved = 0;                         ///< weight of the chain less that of the path
};

/// Allowed ends of a new path: the ends of the chain, or other positions too.
enum class Corners { stay, move };

/// Scratch buffers of a path search; one for each thread.
class PathSearch {
  public:
    PathSearch(std::size_t n_vertices, std::size_t n_half_edges) : goal_(n_half_edges, 0) {
        resize_in_large_pages(at_, n_vertices);
    }

  private:
    friend class SeamPaths;
    static constexpr float kFar = std::numeric_limits<float>::infinity();
    struct QueueEntry {
        float distance;
        std::uint32_t vertex, half;  // one that leaves the vertex
    };
    /// A vertex: how far it is from the chain, and how far and by which half-edge from the start of the path.
    struct Vertex {
        float band = kFar, distance = kFar;
        std::uint32_t reached_by = kNone;
        bool is_start = false;
    };
    std::vector<Vertex> at_;
    std::vector<std::uint8_t> goal_;             // by half-edge
    std::vector<std::uint32_t> starts_, goals_;  // half-edges that leave them
    std::vector<std::uint32_t> marked_, touched_;
    std::vector<std::vector<QueueEntry>> by_distance_;  // of the band, steps of about an edge
};

/// Where the seams of a patch run, chain by chain. Corners are places where three or more
/// seams meet, where one ends, at borders, and at vertices that want a slit.
///
/// Two disks that are glued along one chain are a disk, and any path between two places of its
/// border cuts it into two. A path leaves from the chain's corner or from a place nearby on
/// the borders that the two charts have there with others, so that corners move along.
class SeamPaths {
  public:
    /// `seam` [3n], borders included; `chart` [n] of each triangle, found from the seams when
    /// it is empty. The patch is not needed afterwards.
    SeamPaths(const Patch& patch, std::vector<std::uint8_t> seam, std::vector<std::uint32_t> chart = {});

    const std::vector<std::uint8_t>& seams() const { return seam_; }
    const std::vector<std::uint32_t>& charts() const { return chart_; }

    /// As in the patch.
    std::uint32_t twin(std::uint32_t h) const { return half_[h].twin; }
    float length(std::uint32_t h) const { return half_[h].length; }

    /// Returns scratch buffers for `shorten`.
    PathSearch make_search() const { return {degree_.size(), half_.size()}; }

    /// Whether a chain starts with this half-edge.
    bool starts_chain(std::uint32_t h) const { return seam_[h] && twin(h) != kNone && is_corner(origin(h)); }
    /// Returns the half-edges of the chain that starts with h, in order.
    std::vector<std::uint32_t> chain_from(std::uint32_t h) const;

    /// Returns the shortest path within `reach` times the chain's length of the chain. Edges with a large dihedral
    /// angle have less weight, so seams follow creases. `path` is empty where none is shorter.
    SeamMove shorten(std::vector<std::uint32_t> chain, float reach, Corners corners, PathSearch& search) const;

    /// Moves a seam. Adds to `swept` [2] the triangles that change from the chart on its left to the other one, and
    /// back.
    void move(const SeamMove& move, std::vector<std::uint32_t>* swept = nullptr);

  private:
    static constexpr float kFar = PathSearch::kFar;
    /// What a search asks of a half-edge together: those of a triangle lie in one or two lines of the cache.
    struct HalfEdge {
        std::uint32_t twin = kNone, origin = 0;
        float length = 0;
        float weight = 0;  ///< of its edge
    };
    struct Entry {
        float distance;
        std::uint32_t vertex, half;  // a half-edge that reaches the vertex
        bool operator<(const Entry& o) const { return distance != o.distance ? distance > o.distance : half > o.half; }
    };
    using Queue = std::priority_queue<Entry>;

    std::uint32_t origin(std::uint32_t h) const { return half_[h].origin; }
    std::uint32_t end(std::uint32_t h) const { return half_[next_half(h)].origin; }
    bool is_corner(std::uint32_t v) const { return corner_[v] || degree_[v] != 2; }
    template <class Visit>
    void around(std::uint32_t start, Visit&& visit) const;
    std::uint32_t onward(std::uint32_t h) const;
    std::vector<std::uint32_t> wedge(std::uint32_t h) const;
    void slide(std::uint32_t h, float reach, std::vector<std::uint32_t>& starts) const;
    void mark_band(const std::vector<std::uint32_t>& chain, float reach, PathSearch& search) const;
    /// Resets what a search has written.
    void clear(PathSearch& search) const;
    void set_seam(std::uint32_t h, bool on);
    void sweep(std::uint32_t start, std::uint32_t chart, std::vector<std::uint32_t>* swept);

    std::vector<HalfEdge> half_;
    std::vector<std::uint8_t> seam_;
    std::vector<std::uint32_t> chart_;
    std::vector<std::uint32_t> degree_;          // of vertices, borders included
    std::vector<std::uint8_t> border_, corner_;  // of vertices
    std::vector<std::uint32_t> queue_;
};

}  // namespace tuft::atlas
