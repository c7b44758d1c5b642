#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "../atlas/analytic_surfaces.h"
#include "atlas/texels/log_map.h"
#include "footprint/stamp/plan_scratch.h"
#include "footprint/stamp/stamp.h"

/// A surface with its maps, and what stamps do on it.
namespace tuft::footprint {

inline bool evaluate(const atlas::TexelMap& map, const StampJobs& jobs, const TileJob& job,
                     std::array<float, atlas::kTileTexels>& exposure) {
    Unpacked unpacked;
    return evaluate_tile(map, jobs, job, unpacked, exposure);
}

/// Where the stamp's frames put a texel, metres in the tangent plane.
inline Vec2 place_of(const atlas::TexelMap& map, const StampJobs& jobs, const Footprint& f, std::uint32_t slot, int t) {
    for (const TileJob& job : jobs.tiles) {
        if (job.slot != slot) continue;
        for (std::uint32_t k = job.first; k < job.first + job.count; ++k) {
            if (jobs.frames[k].cluster != map.tiles[slot].cluster[t]) continue;
            const ClusterFrame& p = jobs.piecewise ? jobs.frames[k] : jobs.stamp_frame;
            // log_map is linear in t and b: the picture's axes take their place.
            const Frame frame{Vec3(p.origin), f.cell * Vec3(p.tu), f.cell * Vec3(p.tv), Vec3(p.normal)};
            const Vec3 m = glm::normalize(Vec3(map.normal(slot, t)));
            return atlas::log_map(frame, Vec3(map.position(slot, t)), m) + (Vec2(p.u0, p.v0) + 0.5) * f.cell + f.lo;
        }
    }
    return Vec2{NAN};
}

/// A surface with its maps, and stamps on it.
struct Stage {
    testing::Unwrapped u;
    atlas::TexelMap map;
    atlas::ClusterGraph graph;
    PlanScratch scratch;

    explicit Stage(testing::Unwrapped unwrapped, atlas::TexelStore store = atlas::TexelStore::floats)
        : u(std::move(unwrapped)) {
        map = atlas::build_texel_map(u.mesh, u.atlas, {}, store);
        graph = atlas::build_cluster_graph(u.mesh, u.atlas, map);
    }
    Surface surface() const { return {u.mesh, u.atlas, map, graph}; }

    /// Triangle whose middle is nearest to p, among those that do not face away from `n`.
    std::uint32_t triangle_at(const Vec3& p, const Vec3& n = Vec3{0}) const {
        std::uint32_t best = 0;
        double distance = 1e9;
        for (std::uint32_t t = 0; t < u.mesh.n_triangles(); ++t) {
            const Vec3 c = (u.mesh.position(t, 0) + u.mesh.position(t, 1) + u.mesh.position(t, 2)) / 3.0;
            if (glm::dot(Vec3(u.mesh.corner_normals[3 * t]), n) < 0) continue;
            if (glm::length(c - p) < distance) {
                distance = glm::length(c - p);
                best = t;
            }
        }
        return best;
    }

    StampJobs plan(const Footprint& f, const Motion& motion = {}, const StampOptions& options = {}) {
        StampJobs jobs = plan_stamp(surface(), f, motion, options, {scratch});
        choose_mode(jobs, false, options);
        return jobs;
    }
};

/// Calls visit(slot, texel, exposure) for all texels with any.
template <class Visit>
void for_exposed(const Stage& stage, const StampJobs& jobs, Visit&& visit) {
    std::array<float, atlas::kTileTexels> exposure;
    for (const TileJob& job : jobs.tiles) {
        evaluate(stage.map, jobs, job, exposure);
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (exposure[t] > 0) visit(job.slot, t, exposure[t]);
        }
    }
}

inline double deposit_area(const Stage& stage, const StampJobs& jobs) {
    double sum = 0;
    for_exposed(stage, jobs,
                [&](std::uint32_t slot, int t, float e) { sum += double(e) * stage.map.tiles[slot].area[t]; });
    return sum;
}

inline Vec2 place_of(const Stage& stage, const StampJobs& jobs, const Footprint& f, std::uint32_t slot, int t) {
    return place_of(stage.map, jobs, f, slot, t);
}

inline double disc_area(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0;
    return sum * f.cell * f.cell;
}

struct Errors {
    double mean = 0, max = 0;
    std::size_t n = 0;
};

/// Error of (u, v) over the radius against the exact log map, over all exposed texels.
template <class Exact>
Errors errors(const Stage& stage, const StampJobs& jobs, const Footprint& f, double r, Exact&& exact) {
    Errors e;
    for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float) {
        const Vec2 truth = exact(Vec3(stage.map.position(slot, t)));
        const double error = glm::length(place_of(stage, jobs, f, slot, t) - truth) / r;
        e.mean += error;
        e.max = std::max(e.max, error);
        ++e.n;
    });
    e.mean /= std::max<double>(e.n, 1);
    return e;
}

}  // namespace tuft::footprint
