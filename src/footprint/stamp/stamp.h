#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/texels/cluster_graph.h"
#include "core/geometry/sparse_numbering.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/picture.h"
#include "mesh/query/exact_geodesics.h"

/// From a footprint to the texels it exposes. A caller plans a batch of stamps (each on
/// its own, in any thread), picks the mode of each in stroke order, sorts the tile jobs
/// by slot, and then, one thread per slot, evaluates them in stamp order and lets the ink
/// act. Every function is pure; scratch memory is the caller's.
namespace tuft::footprint {

/// How footprint and surface are matched.
enum class Mapping : std::uint8_t {
    log,    ///< along the surface (log map)
    plane,  ///< paper: from the projection plane along the surface's normals
};

struct Surface {
    const mesh::TriangleMesh& mesh;
    const atlas::Atlas& atlas;
    const atlas::TexelMap& texels;
    const atlas::ClusterGraph& clusters;
};

/// How the footprint came to its present place since the stamp before, in its frame:
/// it was turned by `turn` about the origin and then moved by `shift`.
struct Motion {
    Vec2 shift{0};    ///< metres
    double turn = 0;  ///< radians, counter-clockwise
};

struct StampOptions {
    Mapping mapping = Mapping::log;
    double enter = 0.015;   ///< discrepancy over radius above which clusters get own frames
    double leave = 0.010;   ///< and below which one frame serves all again
    double sub_pose = 1.0;  ///< longest way of any point between sub-poses, texels
    int max_sub_poses = 64;
    int prefix_sums = 12;   ///< straight ways of so many sub-poses and more are integrated at once
    float passes_over = 0;  ///< 0–1: the motion, not turned, leaves so much of what the picture passes over at
                            ///< all, the rest of the mean over it: for hairs finer than a texel
    Isa isa = best_isa();
};

/// Quarters of a tile, a bit each: rows 0–7 with columns 0–7, then 8–15; rows 8–15 likewise.
inline constexpr std::uint8_t kAllQuadrants = 0xf;

/// Where the log map puts the texels of one cluster in the footprint's picture:
/// d = p − origin, (fu, fv) = (u0, v0) + (tu, tv)·d + ½ (a − g) (tu, tv)·m, in cells.
struct ClusterFrame {
    Vec3f origin{0}, normal{0}, tu{0}, tv{0};
    float u0 = 0, v0 = 0;
    std::int32_t cluster = 0;  ///< as in `TexelTile::cluster`
    std::uint8_t first_row = 0, last_row = 0;
    std::uint8_t full_quadrants = 0;  ///< quadrants in which the picture covers all of the cluster in all poses
    std::uint8_t partial_quadrants = kAllQuadrants;  ///< other quadrants in which it may cover some of it
};

struct TileJob {
    std::uint32_t slot = kNone;
    std::uint32_t first = 0, count = 0;  ///< in `StampJobs::frames`
};

/// A pose of the picture within the stamp: the cell coordinates (fu, fv) of a texel lead to the
/// place (xu fu + xv fv + du, yu fu + yv fv + dv) of the packed picture.
struct SubPose {
    float xu = 1, xv = 0, yu = 0, yv = 1, du = 0, dv = 0;
};

/// A planned stamp: its picture packed for the kernel and the tiles it may touch.
struct StampJobs {
    int width = 0, height = 0;         ///< of the picture less one: squares between four cells
    std::vector<std::uint16_t> pairs;  ///< see `pack_picture`
    float gain = 1;                    ///< what full cells of it stand for
    std::vector<SubPose> sub_poses;    ///< evenly spread over the motion
    Vec2f reach_lo{0}, reach_hi{0};    ///< cells: the picture in all its sub-poses
    ClusterFrame stamp_frame;          ///< serves all clusters when not piecewise
    std::vector<ClusterFrame> frames;  ///< one for each cluster reached, by slot; without
                                       ///< a place where discrepancy is below `leave`
    std::vector<TileJob> tiles;        ///< by slot
    double discrepancy = 0;            ///< between the two ways of mapping, over the radius
    bool piecewise = false;            ///< set by `choose_mode`
    Mapping mapping = Mapping::log;
    Isa isa = Isa::baseline;

    bool empty() const { return tiles.empty(); }
};

/// Memory of `sweep`.
struct SweepScratch {
    /// Lines of the picture, by where they begin, between which and over which the motion leads to a place.
    struct SweptLines {
        std::size_t back = 0, on = 0, first = 0, last = 0;
        float after_back = 0, after_on = 0;
    };
    std::vector<SweptLines> swept_lines;
    std::vector<const std::uint8_t*> rows;
    std::vector<std::uint8_t> turned, strip;
    std::vector<float> parts, lines, sums, passed;
    Footprint swept;
};

/// The triangles in which centres of clusters lie, of those looked at since the last clearing.
class TriangleCache {
  public:
    void clear();
    /// kNone: in none that was looked at.
    std::uint32_t of(std::uint32_t cluster) const {
        const std::uint32_t entry = numbers_.find(cluster);
        return entry == kNone ? kNone : entries_[entry].triangle;
    }
    /// The centre of `cluster` lies in `triangle`, or nearly: so far off, squared. The nearest one counts.
    void insert(std::uint32_t cluster, std::uint32_t triangle, double off2);

  private:
    struct Entry {
        std::uint32_t triangle;
        double off2;  ///< m²
    };
    SparseNumbering numbers_;
    std::vector<Entry> entries_;
};

/// Memory of the walk over the clusters; one per thread, any stamp after any other.
struct PlanScratch {
    struct Node {
        std::uint32_t epoch = 0;
        std::uint8_t state = 0;
        float u = 0, v = 0, c = 1, s = 0, key = 0;
        float stretch = 1;  ///< of the map across the radial direction
        bool lit = true;    ///< straight ways lead here from the origin
    };
    std::uint32_t epoch = 0;
    std::vector<Node> nodes;
    std::vector<std::pair<float, std::uint32_t>> heap;
    std::vector<std::uint32_t> reached;
    BlockTally tally;
    Discs discs;
    std::vector<double> apart;         ///< metres, by reached cluster
    std::vector<std::uint32_t> asked;  ///< frames whose quadrants are looked at
    SweepScratch sweep;
    mesh::ExactGeodesics ways;
    TriangleCache triangle_cache;
};

/// Room to unpack a tile into; one per thread.
struct Unpacked {
    std::uint32_t slot = kNone;
    atlas::TexelShape shape;
};

/// Finds the clusters that hang together with the contact point within the footprint and
/// do not face away from it, and their places in its picture. Cost grows with the
/// footprint's area in texels, not with the mesh. `recycled` lends the memory of an earlier
/// stamp; its contents do not matter.
StampJobs plan_stamp(const Surface& surface, const Footprint& footprint, const Motion& motion,
                     const StampOptions& options, PlanScratch& scratch, StampJobs recycled = {});

/// One frame for all clusters or one for each, with hysteresis: `piecewise_before` is the
/// mode of the stamp before in the stroke (false for the first). Returns the mode.
bool choose_mode(StampJobs& jobs, bool piecewise_before, const StampOptions& options);

/// Part of the stamp's motion during which the tuft covers each texel, in [0, 1]; zero
/// for texels outside. Returns false when all are zero. `unpacked` keeps the tile that was
/// unpacked last: stamps on one tile come best one after the other.
bool evaluate_tile(const atlas::TexelMap& texels, const StampJobs& jobs, const TileJob& job, Unpacked& unpacked,
                   std::span<float, atlas::kTileTexels> exposure);

}  // namespace tuft::footprint
