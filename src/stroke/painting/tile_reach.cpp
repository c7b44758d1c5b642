#include "stroke/painting/tile_reach.h"

#include <algorithm>
#include <optional>

#include "core/system/parallel.h"

namespace tuft::stroke {
namespace {

Ball ball_around(std::span<const Ball> balls) {
    Vec3 sum{0};
    double n = 0;
    for (const Ball& b : balls)
        if (b.radius >= 0) sum += b.centre, n += 1;
    if (n == 0) return {};
    Ball all{.centre = sum / n, .radius = 0};
    for (const Ball& b : balls)
        if (b.radius >= 0) all.radius = std::max(all.radius, glm::distance(all.centre, b.centre) + b.radius);
    return all;
}

bool meet(const Ball& a, const Ball& b) {
    const Vec3 d = a.centre - b.centre;
    const double reach = a.radius + b.radius;
    return a.radius >= 0 && b.radius >= 0 && glm::dot(d, d) <= reach * reach;
}

std::optional<mesh::SurfacePoint> foot(const mesh::SurfaceQuery& query, const brush::Pose& pose, double length) {
    if (auto hit = query.ray(pose.position, pose.axis(), 0, length)) return hit;
    return query.closest_point(pose.position, length);
}

}  // namespace

std::vector<std::size_t> parts_of_path(std::span<const brush::Pose> poses, double least) {
    constexpr std::size_t kLeastPoses = 4;
    std::vector<std::size_t> ends;
    double length = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        length += glm::distance(poses[i - 1].position, poses[i].position);
        if (length < least || i + 1 < kLeastPoses + (ends.empty() ? 0 : ends.back())) continue;
        ends.push_back(i + 1);
        length = 0;
    }
    if (ends.empty()) ends.push_back(poses.size());
    ends.back() = poses.size();
    return ends;
}

std::vector<ReachedPlace> reached_places(const mesh::SurfaceQuery& query, std::span<const brush::Pose> poses,
                                         std::span<const std::size_t> parts, const brush::Preset& preset,
                                         double texel) {
    constexpr double kTrail = 1.5;
    const double beside = 0.5 * brush::tuft_width(preset) + 4 * texel;
    const double step = 0.25 * beside;  // poses closer together stand for each other
    std::vector<ReachedPlace> places;
    std::uint32_t part = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const bool begins = i == 0 || i >= parts[part];
        if (i > 0 && i >= parts[part]) ++part;
        const double gap = glm::distance(poses[last].position, poses[i].position);
        if (!begins && gap < step) continue;
        last = i;
        if (const auto at = foot(query, poses[i], preset.length)) {
            const double trail = kTrail * std::max(0.0, preset.length - at->distance);
            places.push_back({{at->position, trail + beside + step + gap}, part, part + 1});
        }
    }
    // Over the last of them the hair leaves the surface; its ink waits for a stamp that does not come.
    const auto end = static_cast<std::uint32_t>(parts.size());
    for (ReachedPlace& place : places)
        if (place.last >= places.back().first) place.last = end;
    return places;
}

TileReach::TileReach(const atlas::TexelMap& map, const atlas::ClusterGraph& graph)
    : first_(map.cluster_start), clusters_(graph.n_clusters()), groups_((map.n_slots() + kGroup - 1) / kGroup) {
    parallel_for(groups_.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            const std::size_t first = g * kGroup, last = std::min(first + kGroup, map.n_slots());
            for (std::size_t i = first_[first]; i < first_[last]; ++i) {
                const atlas::TexelCluster& c = graph.clusters[i];
                clusters_[i] = {Vec3(c.centre), static_cast<double>(c.radius) + static_cast<double>(map.reach[c.slot])};
            }
            groups_[g] = ball_around(balls_of(first, last));
        }
    });
}

TilePlan TileReach::tiles_at(std::span<const ReachedPlace> places) const {
    TilePlan tiles;
    std::vector<ReachedPlace> near;
    std::vector<Ball> balls;
    balls.reserve(places.size());
    for (const ReachedPlace& place : places) balls.push_back(place.ball);
    const Ball all = ball_around(balls);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (!meet(groups_[g], all)) continue;
        near.clear();
        std::ranges::copy_if(places, std::back_inserter(near),
                             [&](const ReachedPlace& place) { return meet(groups_[g], place.ball); });
        const std::size_t first = g * kGroup, last = std::min(first + kGroup, first_.size() - 1);
        for (std::size_t slot = first; !near.empty() && slot < last; ++slot) {
            TileUse use{static_cast<std::uint32_t>(slot), kNone, 0};
            for (const ReachedPlace& place : near) {
                if (use.first <= place.first && place.last <= use.last) continue;
                const auto meets = [&](const Ball& ball) { return meet(ball, place.ball); };
                if (!std::ranges::any_of(balls_of(slot, slot + 1), meets)) continue;
                use.first = std::min(use.first, place.first);
                use.last = std::max(use.last, place.last);
            }
            if (use.first != kNone) tiles.push_back(use);
        }
    }
    return tiles;
}

}  // namespace tuft::stroke
