#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/texels/cluster_graph.h"
#include "core/system/recycled.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/picture.h"

/// \file
/// From a footprint to the texels it exposes. `stroke` calls it for each batch of stamps.
///
/// A caller plans a batch of stamps (`plan_stamp`, any thread). It chooses the mode of each in stroke order
/// (`choose_mode`) and sorts the tile jobs by slot. Then one thread per slot evaluates the jobs in stamp order
/// (`evaluate_tile`) and deposits the ink. All functions are pure; the caller owns the scratch memory (plan_scratch.h).
namespace tuft::footprint {

/// Mapping between footprint and surface.
enum class Mapping : std::uint8_t {
    log,    ///< along the surface (log map)
    plane,  ///< paper: from the projection plane along the surface's normals
};

/// A model and its texels; the references must outlive it.
struct Surface {
    const mesh::TriangleMesh& mesh;
    const atlas::Atlas& atlas;            ///< of the mesh
    const atlas::TexelMap& texels;        ///< of the atlas
    const atlas::ClusterGraph& clusters;  ///< of the texels
};

/// Motion of the footprint since the previous stamp, in its frame: a rotation by `turn` about the origin, then a
/// translation by `shift`.
struct Motion {
    Vec2 shift{0};    ///< metres
    double turn = 0;  ///< radians, counter-clockwise
};

/// Options of `plan_stamp` and `choose_mode`.
struct StampOptions {
    Mapping mapping = Mapping::log;
    double enter = 0.015;    ///< discrepancy over radius above which each cluster gets a frame
    double leave = 0.010;    ///< discrepancy over radius below which one frame serves all again
    double sub_pose = 1.0;   ///< largest displacement of any point between sub-poses, texels
    int max_sub_poses = 64;  ///< of a stamp; longer motions have poses further apart
    int prefix_sums = 12;    ///< number of sub-poses from which a straight motion is integrated by prefix sums
    /// 0–1: weight of the maximum over a straight motion, against the mean; for hairs finer than a texel.
    float max_weight = 0;
    Isa isa = best_isa();  ///< of the kernels; no bit depends on it
};

/// Quadrants of a tile, one bit each: rows 0–7 with columns 0–7, then 8–15; rows 8–15 likewise.
inline constexpr std::uint8_t kAllQuadrants = 0xf;

/// Log map of the texels of one cluster into the footprint's picture: d = p − origin, (fu, fv) = (u0, v0) + (tu,
/// tv)·d + ½ (a − g) (tu, tv)·m, in cells.
struct ClusterFrame {
    Vec3f origin{0};                           ///< metres, world
    Vec3f normal{0};                           ///< unit, world
    Vec3f tu{0}, tv{0};                        ///< cells a metre, world: axes of the picture
    float u0 = 0, v0 = 0;                      ///< cells, of `origin` in the picture
    std::int32_t cluster = 0;                  ///< as in `TexelTile::cluster`
    std::uint8_t first_row = 0, last_row = 0;  ///< of the tile, that hold texels of the cluster
    std::uint8_t full_quadrants = 0;  ///< quadrants in which the picture covers all of the cluster in all poses
    std::uint8_t partial_quadrants = kAllQuadrants;  ///< other quadrants in which it may cover some of it
};

/// The frames of one tile that a stamp may touch.
struct TileJob {
    std::uint32_t slot = kNone;          ///< of the tile in the texel map
    std::uint32_t first = 0, count = 0;  ///< in `StampJobs::frames`
};

/// A pose of the picture within the stamp: cell coordinates (fu, fv) of a texel map to (xu fu + xv fv + du, yu fu +
/// yv fv + dv) of the picture.
struct SubPose {
    float xu = 1, xv = 0, yu = 0, yv = 1;  ///< rotation and shear
    float du = 0, dv = 0;                  ///< cells
};

/// A planned stamp: its picture and the tiles it may touch.
struct StampJobs {
    int width = 0, height = 0;       ///< ≥ 1, squares between four cells: the picture's size less one
    Recycled<std::uint8_t> cells;    ///< [(height + 1) (width + 1)], 255 = 1
    float gain = 1;                  ///< exposure of a full cell
    std::vector<SubPose> sub_poses;  ///< evenly spaced over the motion
    Vec2f reach_lo{0}, reach_hi{0};  ///< cells: bounds of the picture in all sub-poses
    ClusterFrame stamp_frame;        ///< serves all clusters when not piecewise
    /// One for each cluster reached, by slot; without a position where discrepancy is below `leave`.
    std::vector<ClusterFrame> frames;
    std::vector<TileJob> tiles;  ///< by slot
    double discrepancy = 0;      ///< between one frame and one per cluster, over the radius
    bool piecewise = false;      ///< set by `choose_mode`
    Mapping mapping = Mapping::log;
    Isa isa = Isa::baseline;

    bool empty() const { return tiles.empty(); }
};

/// Clusters round several stamps, where the surface is smooth; see neighbourhood.h.
struct Neighbourhood {
    std::vector<std::uint32_t> clusters;  ///< ascending; empty: none known, each stamp searches
    /// Of each cluster, and zeros up to whole vectors: centre (metres) and unit normal, world; radius of a disc that
    /// holds its texels, metres.
    std::vector<float> px, py, pz, nx, ny, nz, radius;
};

/// Buffer for an unpacked tile; one per thread.
struct Unpacked {
    std::uint32_t slot = kNone;  ///< of the tile unpacked last; kNone: none
    atlas::TexelShape shape;     ///< its texels
};

struct PlanScratch;

/// What plans of stamps use again.
struct PlanMemory {
    PlanScratch& scratch;     ///< of the thread (plan_scratch.h)
    StampJobs recycled = {};  ///< lends the memory of an earlier stamp; its contents are ignored
};

/// Plans a stamp: finds the clusters within the footprint that are connected to the contact point and do not face
/// away from it, and their positions in the picture. Cost is proportional to the footprint's area in texels and
/// does not depend on the mesh. `around`: of stamps of which this is one, found with the same options; empty: the stamp
/// searches by itself.
StampJobs plan_stamp(const Surface& surface, const Footprint& footprint, const Motion& motion,
                     const StampOptions& options, PlanMemory memory, const Neighbourhood& around = {});

/// Chooses one frame for all clusters or one for each, with hysteresis. `piecewise_before` is the mode of the
/// previous stamp of the stroke (false for the first). Returns the mode.
bool choose_mode(StampJobs& jobs, bool piecewise_before, const StampOptions& options);

/// Computes the fraction of the stamp's motion during which the tuft covers each texel, in [0, 1]; 0 for texels
/// outside. Returns false when all are 0. `unpacked` caches the tile unpacked last: evaluate stamps of one tile
/// consecutively.
bool evaluate_tile(const atlas::TexelMap& texels, const StampJobs& jobs, const TileJob& job, Unpacked& unpacked,
                   std::span<float, atlas::kTileTexels> exposure);

}  // namespace tuft::footprint
