#include "stroke/document/tile_reach.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "core/system/parallel.h"

namespace tuft::stroke {
namespace {

// A tile at the border of a chart may hold texels of others, far away on the surface: one ball for each cluster, round
// every third texel of every third row, and as far beyond as two texels are apart.
void add_balls(const atlas::TexelMap& map, std::uint32_t slot, std::span<Ball> balls) {
    constexpr int kEach = 3;
    const double beyond = 2 * std::numbers::sqrt2 * static_cast<double>(map.reach[slot]);
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(map, slot, buffer);
    const auto& cluster = map.tiles[slot].cluster;
    std::array<Ball, atlas::kTileTexels> sampled;  // radius: number of texels sampled
    for (Ball& ball : std::span(sampled).first(balls.size())) ball = {Vec3{0}, 0};
    const auto each_sample = [&](const auto& visit) {
        for (int row = 0; row < atlas::kTile; row += kEach)
            for (int column = 0; column < atlas::kTile; column += kEach) {
                const auto t = static_cast<std::size_t>(row * atlas::kTile + column);
                if (cluster[t] != atlas::kNoCluster) visit(cluster[t], Vec3(shape.px[t], shape.py[t], shape.pz[t]));
            }
    };
    each_sample([&](std::uint8_t c, const Vec3& p) { sampled[c].centre += p, sampled[c].radius += 1; });
    for (std::size_t c = 0; c < balls.size(); ++c)
        if (sampled[c].radius > 0) balls[c] = {sampled[c].centre / sampled[c].radius, beyond};
    each_sample([&](std::uint8_t c, const Vec3& p) {
        balls[c].radius = std::max(balls[c].radius, glm::distance(balls[c].centre, p) + beyond);
    });
    // A cluster between the samples.
    for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
        if (const std::uint8_t c = cluster[t]; c != atlas::kNoCluster && balls[c].radius < 0)
            balls[c] = {Vec3(shape.px[t], shape.py[t], shape.pz[t]), 2 * beyond};
}

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
    return places;
}

TileReach::TileReach(const atlas::TexelMap& map)
    : first_(map.cluster_start), clusters_(map.cluster_start.back()), groups_((map.n_slots() + kGroup - 1) / kGroup) {
    parallel_for(groups_.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            const std::size_t first = g * kGroup, last = std::min(first + kGroup, map.n_slots());
            for (std::size_t slot = first; slot < last; ++slot)
                if (first_[slot] < first_[slot + 1])
                    add_balls(map, static_cast<std::uint32_t>(slot), balls_of(slot, slot + 1));
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
