#include "footprint/stamp/stamp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atlas/texels/log_map.h"
#include "footprint/outline/picture.h"
#include "footprint/stamp/neighbourhood.h"
#include "footprint/stamp/occluded.h"
#include "footprint/stamp/quadrants.h"
#include "footprint/stamp/sweep.h"
#include "footprint/stamp/walk.h"

namespace tuft::footprint {
namespace {

constexpr double kShadow = 0.1;  // of its distance: what a cluster behind an opening may be off by

/// Frame of texels whose log map in `frame` is at `place` + turn · (u, v) in the stamp.
ClusterFrame picture_frame(const Frame& frame, const Vec2& place, const Vec2& turn, const Footprint& footprint) {
    ClusterFrame f;
    const double scale = 1 / footprint.cell;
    f.origin = Vec3f(frame.origin);
    f.normal = Vec3f(frame.n);
    f.tu = Vec3f(scale * (turn.x * frame.t - turn.y * frame.b));
    f.tv = Vec3f(scale * (turn.y * frame.t + turn.x * frame.b));
    f.u0 = static_cast<float>((place.x - footprint.lo.x) * scale - 0.5);
    f.v0 = static_cast<float>((place.y - footprint.lo.y) * scale - 0.5);
    return f;
}

/// Returns the number of sub-poses at which no point moves further than `sub_pose` between them; 0: nothing moves.
double count_sub_poses(const Footprint& footprint, const Motion& motion, double texel_size,
                       const StampOptions& options) {
    const double travel = glm::length(motion.shift) + std::abs(motion.turn) * footprint.radius;
    if (!(travel > 0)) return 0;
    const double step = options.sub_pose * texel_size;
    return step > 0 ? std::ceil(travel / step) : 1;
}

/// Poses of the picture at the middles of equal parts of the motion. At a part σ before
/// its end a texel at (u, v) sees the picture's point x = R(σ turn) ((u, v) + σ shift).
void set_sub_poses(const Footprint& footprint, const Motion& motion, double texel_size, const StampOptions& options,
                   std::vector<SubPose>& poses) {
    const double wanted = count_sub_poses(footprint, motion, texel_size, options);
    if (!(wanted > 0)) return poses.assign(1, {});
    const int n = static_cast<int>(std::clamp(wanted, 1.0, double(std::max(options.max_sub_poses, 1))));
    poses.resize(n);
    const Vec2 zero = footprint.lo / footprint.cell + 0.5;  // cell (0, 0) in cells from the origin
    for (int k = 0; k < n; ++k) {
        const double rest = 1 - (k + 0.5) / n;
        const double c = std::cos(rest * motion.turn), s = std::sin(rest * motion.turn);
        const Vec2 p = zero + rest * motion.shift / footprint.cell;
        const auto cos = static_cast<float>(c), sin = static_cast<float>(s);
        poses[k] = {cos,
                    -sin,
                    sin,
                    cos,
                    static_cast<float>(c * p.x - s * p.y - zero.x),
                    static_cast<float>(s * p.x + c * p.y - zero.y)};
    }
}

/// Finds the discs that hold the texels of the reached clusters in either mode and in all poses, with the next cell;
/// and the disagreement of the modes.
void find_discs(const atlas::ClusterGraph& graph, const Footprint& footprint, const Motion& motion,
                PlanScratch& scratch) {
    const auto cell = static_cast<float>(footprint.cell);
    const Vec2f zero = Vec2f(footprint.lo / footprint.cell + 0.5);
    const Vec2f half_shift = Vec2f(0.5 * motion.shift);
    const float half_length = glm::length(half_shift), turn = static_cast<float>(std::abs(motion.turn));
    scratch.disagreement.clear();
    scratch.discs.clear();
    for (const std::uint32_t i : scratch.reached) {
        const atlas::TexelCluster& cluster = graph.clusters[i];
        const PlanScratch::Node& at = scratch.nodes[i];
        scratch.disagreement.push_back(disagreement(footprint.frame, cluster, at));
        const Vec2f position = Vec2f{at.u, at.v} + half_shift;
        const float r = kClusterSlack * cluster.radius, swing = turn * (glm::length(position) + half_length + r);
        const float reach = r + static_cast<float>(scratch.disagreement.back()) + half_length + swing;
        scratch.discs.add(position / cell - zero, reach / cell + 1.5f);
    }
}

/// Lists the reached clusters that the picture may cover, with its coverage there as far as it is known;
/// scratch.reached and scratch.disagreement are left with those listed.
void list_clusters(const atlas::ClusterGraph& graph, const Footprint& footprint, PlanScratch& scratch,
                   StampJobs& jobs) {
    scratch.tally.count(footprint);
    scratch.tally.find_coverage(scratch.discs, jobs.isa);
    const Vec3f normal(footprint.frame.n);
    std::size_t n = 0;
    jobs.frames.reserve(scratch.reached.size());
    for (std::size_t k = 0; k < scratch.reached.size(); ++k) {
        const std::uint32_t i = scratch.reached[k];
        const atlas::TexelCluster& cluster = graph.clusters[i];
        ClusterFrame f;
        if (jobs.mapping == Mapping::log) {
            const Cover cover = scratch.discs.cover(k);
            if (cover == Cover::empty) continue;
            if (cover == Cover::full && is_facing(cluster, normal)) {
                f.full_quadrants = kAllQuadrants;
                f.partial_quadrants = 0;
            }
        }
        if (jobs.tiles.empty() || jobs.tiles.back().slot != cluster.slot)
            jobs.tiles.push_back({cluster.slot, static_cast<std::uint32_t>(jobs.frames.size()), 0});
        ++jobs.tiles.back().count;
        f.cluster = cluster.index;
        f.first_row = cluster.first_row;
        f.last_row = cluster.last_row;
        jobs.frames.push_back(f);
        scratch.disagreement[n] = scratch.disagreement[k];
        scratch.reached[n++] = i;
    }
    scratch.reached.resize(n);
}

/// Greatest disagreement over the listed clusters, over the radius.
double discrepancy_of(const Footprint& footprint, const PlanScratch& scratch) {
    double most = 0;
    for (std::size_t k = 0; k < scratch.reached.size(); ++k) {
        const PlanScratch::Node& at = scratch.nodes[scratch.reached[k]];
        const double off = scratch.disagreement[k];
        // Behind an opening the walk itself is in doubt: it went round.
        if (at.lit || off > kShadow * static_cast<double>(glm::length(Vec2f{at.u, at.v}))) most = std::max(most, off);
    }
    return most / std::max(footprint.radius, 1e-12);
}

/// Stretches the picture's axes across the radial direction.
void stretch_frame(ClusterFrame& f, const PlanScratch::Node& at) {
    const float d2 = at.u * at.u + at.v * at.v;
    if (!(d2 > 0)) return;
    const float more = at.stretch - 1;
    const float tt = more * at.v * at.v / d2, tr = -more * at.u * at.v / d2, rr = more * at.u * at.u / d2;
    for (int k = 0; k < 3; ++k) {
        const float u = f.tu[k], v = f.tv[k];
        f.tu[k] = u + tt * u + tr * v;
        f.tv[k] = v + tr * u + rr * v;
    }
}

/// Gives each cluster the frame it needs when they have their own.
void place_clusters(const atlas::ClusterGraph& graph, const Footprint& footprint, const PlanScratch& scratch,
                    StampJobs& jobs) {
    for (std::size_t k = 0; k < jobs.frames.size(); ++k) {
        const PlanScratch::Node& at = scratch.nodes[scratch.reached[k]];
        const ClusterFrame& old = jobs.frames[k];
        ClusterFrame f =
            picture_frame(frame_of(graph.clusters[scratch.reached[k]]), Vec2(at.u, at.v), Vec2(at.c, at.s), footprint);
        if (at.stretch != 1) stretch_frame(f, at);
        f.cluster = old.cluster;
        f.first_row = old.first_row;
        f.last_row = old.last_row;
        f.full_quadrants = old.full_quadrants;
        f.partial_quadrants = old.partial_quadrants;
        jobs.frames[k] = f;
    }
}

/// Finds the covered quadrants of clusters of whole tiles that the picture covers in part. Between the two thresholds
/// of discrepancy a cluster may be mapped by either frame.
void classify_clusters(const Surface& surface, const Footprint& footprint, const Motion& motion,
                       const StampOptions& options, PlanScratch& scratch, StampJobs& jobs) {
    if (jobs.mapping != Mapping::log) return;
    const auto [low, high] = std::minmax(options.enter, options.leave);
    const bool either = jobs.discrepancy > low && jobs.discrepancy <= high;
    const bool own = jobs.discrepancy > high;
    const auto cell = static_cast<float>(footprint.cell);
    const Vec3f normal(footprint.frame.n);
    SweptDisplacement displacement{Vec2f(footprint.lo / footprint.cell + 0.5), Vec2f(0.5 * motion.shift) / cell,
                                   static_cast<float>(std::abs(motion.turn))};
    if (either) displacement.extra = 1 + static_cast<float>(jobs.discrepancy * footprint.radius) / cell;
    scratch.queried.clear();
    scratch.discs.clear();
    for (const TileJob& job : jobs.tiles) {
        for (std::uint32_t k = job.first; k < job.first + job.count; ++k) {
            const ClusterFrame& f = jobs.frames[k];
            const std::uint32_t i = scratch.reached[k];
            if (f.partial_quadrants == 0 || f.first_row > 0 || f.last_row + 1 < atlas::kTile) continue;
            if (!is_facing(surface.clusters.clusters[i], normal) || (either && !scratch.nodes[i].lit)) continue;
            if (add_quadrants(own ? f : jobs.stamp_frame, f.cluster, surface.texels, job.slot, displacement,
                              scratch.discs))
                scratch.queried.push_back(k);
        }
    }
    scratch.tally.find_coverage(scratch.discs, jobs.isa);
    for (std::size_t n = 0; n < scratch.queried.size(); ++n)
        classify_quadrants(scratch.discs, kQuadrants * n, jobs.frames[scratch.queried[n]]);
}

}  // namespace

StampJobs plan_stamp(const Surface& surface, const Footprint& footprint, const Motion& motion,
                     const StampOptions& options, PlanMemory memory, const Neighbourhood& around) {
    PlanScratch& scratch = memory.scratch;
    StampJobs jobs = std::move(memory.recycled);
    jobs.frames.clear();
    jobs.tiles.clear();
    jobs.sub_poses.clear();
    jobs.gain = 1;
    jobs.discrepancy = 0;
    jobs.piecewise = false;
    jobs.mapping = options.mapping;
    jobs.isa = options.isa;
    if (footprint.empty() || footprint.width < 2 || footprint.height < 2) return jobs;
    const atlas::TexelRef contact =
        atlas::texel_at(surface.mesh, surface.atlas, surface.texels, footprint.triangle, footprint.frame.origin);
    if (!contact.valid()) return jobs;
    const Reach reach = reach_of(footprint, motion);
    jobs.stamp_frame = picture_frame(footprint.frame, Vec2{0}, Vec2{1, 0}, footprint);
    const bool shared =
        options.mapping == Mapping::log &&
        std::binary_search(around.clusters.begin(), around.clusters.end(), cluster_of(surface.texels, contact));
    if (shared) {
        reach_clusters(around, footprint, motion, reach, jobs.stamp_frame, scratch);
        scratch.disagreement.assign(scratch.reached.size(), 0.0);
    } else {
        const Start start = start_of(surface, footprint, contact);
        const std::size_t occluded = walk_clusters(surface.clusters, reach, start, scratch);
        resolve_occluded(surface, reach, start, occluded, scratch);
        find_discs(surface.clusters, footprint, motion, scratch);
    }
    if (scratch.reached.empty()) return jobs;

    const double texel_size = surface.texels.texel_size;
    const double wanted = motion.turn == 0 ? count_sub_poses(footprint, motion, texel_size, options) : 0;
    const bool takes_max = options.max_weight > 0 && wanted > 0;
    const bool swept = takes_max || (options.prefix_sums > 0 && wanted >= options.prefix_sums);
    if (!swept) set_sub_poses(footprint, motion, texel_size, options, jobs.sub_poses);
    list_clusters(surface.clusters, footprint, scratch, jobs);
    if (!shared) jobs.discrepancy = discrepancy_of(footprint, scratch);
    if (jobs.discrepancy > std::min(options.enter, options.leave))
        place_clusters(surface.clusters, footprint, scratch, jobs);
    classify_clusters(surface, footprint, motion, options, scratch, jobs);
    const Vec2f to_cells = Vec2f(footprint.lo / footprint.cell + 0.5);
    jobs.reach_lo = reach.lo / float(footprint.cell) - to_cells - 2.0f;
    jobs.reach_hi = reach.hi / float(footprint.cell) - to_cells + 2.0f;
    if (swept) {
        if (takes_max)
            sweep_over(footprint, motion.shift, options.max_weight, jobs, scratch.sweep);
        else
            sweep(footprint, motion.shift, jobs, scratch.sweep);
        return jobs;
    }
    jobs.width = footprint.width - 1;
    jobs.height = footprint.height - 1;
    jobs.cells = footprint.coverage;
    return jobs;
}

bool choose_mode(StampJobs& jobs, bool piecewise_before, const StampOptions& options) {
    jobs.piecewise =
        jobs.mapping == Mapping::log && jobs.discrepancy > (piecewise_before ? options.leave : options.enter);
    return jobs.piecewise;
}

}  // namespace tuft::footprint
