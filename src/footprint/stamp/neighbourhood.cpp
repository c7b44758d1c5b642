#include "footprint/stamp/neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "atlas/texels/log_map.h"
#include "core/simd.h"
#include "footprint/stamp/picture_map.h"

namespace tuft::footprint {
namespace {

constexpr double kSameSide = 0.9;   // cosine of the angle between normals of stamps
constexpr double kPad = 0.02;       // of the radius: what maps about two origins may differ by
constexpr double kMostOff = 0.5;    // of the discrepancy below which one frame serves all
constexpr double kMostArea = 0.4;   // of the stamps' areas together: costs less than a search for each
constexpr std::size_t kLanes = 16;  // of a vector of floats

double area_with_margin(const Vec2& extent, double margin) {
    return (extent.x + 2 * margin) * (extent.y + 2 * margin);
}

/// Bounds of all stamps in the tangent plane of one of them.
struct Bounds {
    Vec2 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    double radius = 0, least_radius = std::numeric_limits<double>::infinity();
    double areas = 0;  ///< m², with a margin of a tile

    /// Returns false where the stamp's plane is too steep on the other's.
    bool add(const Frame& plane, const MovedFootprint& stamp, double margin) {
        const Footprint& f = stamp.footprint;
        if (!(glm::dot(plane.n, f.frame.n) > kSameSide)) return false;
        const Reach own = reach_of(f, stamp.motion);
        const Vec2 at = atlas::log_map(plane, f.frame.origin, f.frame.n);
        const Vec2 turn = atlas::transport_direction(plane, f.frame.t, f.frame.n);
        for (const float u : {own.lo.x, own.hi.x})
            for (const float v : {own.lo.y, own.hi.y}) {
                const Vec2 corner = at + Vec2{turn.x * u - turn.y * v, turn.y * u + turn.x * v};
                lo = glm::min(lo, corner);
                hi = glm::max(hi, corner);
            }
        radius = std::max(radius, glm::length(at) + static_cast<double>(own.radius));
        least_radius = std::min(least_radius, f.radius);
        areas += area_with_margin(Vec2(own.hi - own.lo), margin);
        return true;
    }
};

void gather_clusters(const atlas::ClusterGraph& graph, Neighbourhood& out) {
    const std::size_t n = (out.clusters.size() + kLanes - 1) / kLanes * kLanes;
    for (std::vector<float>* v : {&out.px, &out.py, &out.pz, &out.nx, &out.ny, &out.nz, &out.radius}) v->assign(n, 0);
    for (std::size_t k = 0; k < out.clusters.size(); ++k) {
        const atlas::TexelCluster& cluster = graph.clusters[out.clusters[k]];
        out.px[k] = cluster.centre.x;
        out.py[k] = cluster.centre.y;
        out.pz[k] = cluster.centre.z;
        out.nx[k] = cluster.normal.x;
        out.ny[k] = cluster.normal.y;
        out.nz[k] = cluster.normal.z;
        out.radius[k] = kClusterSlack * cluster.radius;
    }
}

/// Positions of the clusters' centres in the picture, cells.
TUFT_CLONES void map_centres(const Neighbourhood& around, const ClusterFrame& frame, float* __restrict u,
                             float* __restrict v) {
    const float *px = around.px.data(), *py = around.py.data(), *pz = around.pz.data();
    const float *nx = around.nx.data(), *ny = around.ny.data(), *nz = around.nz.data();
    const std::size_t n = around.px.size();
#pragma omp simd
    for (std::size_t k = 0; k < n; ++k) {
        const MappedTexel at = map_texel<false>(frame, {px[k], py[k], pz[k], nx[k], ny[k], nz[k]});
        u[k] = at.u;
        v[k] = at.v;
    }
}

}  // namespace

Neighbourhood find_neighbourhood(const Surface& surface, std::span<const MovedFootprint> stamps,
                                 const StampOptions& options, PlanScratch& scratch, Neighbourhood memory) {
    Neighbourhood out = std::move(memory);
    out.clusters.clear();
    if (options.mapping != Mapping::log || stamps.empty()) return out;
    const MovedFootprint& middle = stamps[stamps.size() / 2];
    const Footprint& f = middle.footprint;
    if (f.empty()) return out;
    Bounds bounds;
    const double margin = atlas::kTile * surface.texels.texel_size;
    for (const MovedFootprint& stamp : stamps)
        if (!stamp.footprint.get().empty() && !bounds.add(f.frame, stamp, margin)) return out;
    const double pad = kPad * bounds.radius;
    if (!(area_with_margin(bounds.hi - bounds.lo, margin + pad) < kMostArea * bounds.areas)) return out;
    const atlas::TexelRef contact =
        atlas::texel_at(surface.mesh, surface.atlas, surface.texels, f.triangle, f.frame.origin);
    if (!contact.valid()) return out;
    Reach reach = reach_of(f, middle.motion);
    reach.radius = static_cast<float>(bounds.radius + pad);
    reach.lo = Vec2f(bounds.lo - pad);
    reach.hi = Vec2f(bounds.hi + pad);
    const double most_off = kMostOff * std::min(options.enter, options.leave) * bounds.least_radius;
    if (!walk_smooth(surface.clusters, reach, start_of(surface, f, contact), f.frame, most_off, scratch)) return out;
    out.clusters.assign(scratch.reached.begin(), scratch.reached.end());
    gather_clusters(surface.clusters, out);
    return out;
}

void reach_clusters(const Neighbourhood& around, const Footprint& footprint, const Motion& motion, const Reach& reach,
                    const ClusterFrame& stamp_frame, PlanScratch& scratch) {
    std::vector<float>&u = scratch.place_u, &v = scratch.place_v;
    u.resize(around.px.size());
    v.resize(around.px.size());
    map_centres(around, stamp_frame, u.data(), v.data());
    const auto cell = static_cast<float>(footprint.cell);
    const Vec2f zero = Vec2f(footprint.lo / footprint.cell + 0.5), lo = reach.lo / cell - zero,
                hi = reach.hi / cell - zero;
    const Vec2f half_shift = Vec2f(0.5 * motion.shift) / cell;
    const float half_length = glm::length(half_shift), turn = static_cast<float>(std::abs(motion.turn));
    scratch.reached.clear();
    scratch.discs.clear();
    for (std::size_t k = 0; k < around.clusters.size(); ++k) {
        const float r = around.radius[k] / cell;
        const float du = std::max({lo.x - u[k], u[k] - hi.x, 0.0f}), dv = std::max({lo.y - v[k], v[k] - hi.y, 0.0f});
        if (du * du + dv * dv > r * r) continue;
        const Vec2f position = Vec2f{u[k], v[k]} + half_shift;
        const float swing = turn > 0 ? turn * (glm::length(position + zero) + half_length + r) : 0.0f;
        scratch.reached.push_back(around.clusters[k]);
        scratch.discs.add(position, r + half_length + swing + 1.5f);
    }
}

}  // namespace tuft::footprint
