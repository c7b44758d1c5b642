#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/sparse_numbering.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/picture.h"
#include "mesh/query/exact_geodesics.h"

/// \file
/// Scratch memory of `plan_stamp`, one per thread. Its contents mean nothing between two stamps; it is kept so that a
/// stamp allocates nothing.
namespace tuft::footprint {

/// Scratch memory of `sweep`. A strip is 64 values of each line of the sheared picture.
struct SweepScratch {
    /// Lines of a strip whose maximum is that of the motion over one position: those between which its ends lie, and
    /// two runs of lines that cover those between the ends. All but `after_*` are offsets of lines in the strip.
    struct SweptLines {
        std::size_t back = 0, on = 0;        ///< line before the motion's beginning, and before its end
        std::size_t first = 0, last = 0;     ///< first line of each run
        float after_back = 0, after_on = 0;  ///< 0–1, position of the ends between their line and the next
    };
    std::vector<SweptLines> swept_lines;    ///< by line of the result
    std::vector<const std::uint8_t*> rows;  ///< by line: its first cell in the strip
    Recycled<std::uint8_t> transposed;      ///< the picture by columns
    std::vector<std::uint8_t> strip;        ///< cells of lines that leave the picture; rounded results
    std::vector<float> parts;               ///< 0–1, by line: position of the strip between two cells
    std::vector<float> lines;               ///< values of the strip, with empty lines before and after
    std::vector<float> sums;                ///< their prefix sums, or the maxima of runs of lines
    std::vector<float> maxima;              ///< of the motion, by line of the result
    Footprint swept;                        ///< the result
};

/// Cache of the triangles that contain cluster centres, since the last `clear`.
class TriangleCache {
  public:
    void clear();
    /// Returns the triangle of `cluster`; kNone: not in the cache.
    std::uint32_t of(std::uint32_t cluster) const {
        const std::uint32_t entry = numbers_.find(cluster);
        return entry == kNone ? kNone : entries_[entry].triangle;
    }
    /// Records that the centre of `cluster` lies in `triangle`, at squared distance `off2`. The nearest triangle is
    /// retained.
    void insert(std::uint32_t cluster, std::uint32_t triangle, double off2);

  private:
    struct Entry {
        std::uint32_t triangle;
        double off2;  ///< m²
    };
    SparseNumbering numbers_;
    std::vector<Entry> entries_;
};

/// Scratch memory of the cluster search; one per thread, reusable for any stamp.
struct PlanScratch {
    /// A cluster in the search.
    struct Node {
        std::uint32_t epoch = 0;  ///< of the search that wrote the node; another: the node is unvisited
        std::uint8_t state = 0;   ///< see walk.h: open, final or outside
        float u = 0, v = 0;       ///< metres, of the cluster's centre in the stamp's plane
        float c = 1, s = 0;       ///< cosine and sine of the rotation of its frame there
        float key = 0;            ///< m², squared length of the shortest path found, by which the heap is ordered
        float stretch = 1;        ///< of the map across the radial direction
        bool lit = true;          ///< reached by a straight path from the origin
    };
    std::uint32_t epoch = 0;                            ///< of the search in work
    std::vector<Node> nodes;                            ///< by cluster
    std::vector<std::pair<float, std::uint32_t>> heap;  ///< keys and clusters
    std::vector<std::uint32_t> reached;                 ///< clusters that the picture reaches, ascending
    BlockTally tally;                                   ///< of the picture
    Discs discs;                                        ///< of clusters, then of quadrants
    std::vector<float> place_u, place_v;                ///< cells, by cluster of a neighbourhood
    std::vector<double> disagreement;                   ///< metres, by reached cluster, between the two mappings
    std::vector<std::uint32_t> queried;                 ///< frames whose quadrants are queried
    SweepScratch sweep;
    mesh::ExactGeodesics geodesics;
    TriangleCache triangle_cache;
};

}  // namespace tuft::footprint
