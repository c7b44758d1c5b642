#include "stroke/pointer/aim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/ease.h"

namespace tuft::stroke {
namespace {

constexpr double kShallow = 0.2;             // of the reach for gaps: what is less deep is relief, and followed
constexpr double kBent = 0.5;                // of it: how far two sides of a gap may lie out of one plane
constexpr int kPairs = 12;                   // of rays round the aim
constexpr std::size_t kAgreeing = 3;         // of them that must lie on the surface
constexpr double kWall = 0.25, kLip = 0.55;  // radians from the mean normal: of a wall beside a lip at most, of a lip

Vec3 facing(const mesh::SurfacePoint& p, const Aim& aim) {
    return glm::dot(p.normal, aim.ray.direction) < 0 ? p.normal : -p.normal;
}

}  // namespace

std::optional<mesh::SurfacePoint> aim_at(const mesh::SurfaceQuery& surface, const Aim& aim) {
    double from = 0;
    for (int i = 0; i < 64; ++i) {
        auto hit = surface.ray(aim.ray.origin, aim.ray.direction, from);
        if (!hit || glm::dot(Vec4(hit->position, 1), Vec4(aim.section)) <= 0) return hit;
        from = hit->distance + 1e-6;
    }
    return std::nullopt;
}

// Of even directions over the place, by the cosine, the part that meets a back: all inside of a closed body, none over
// a sheet, 0.36 in half a pipe.
bool is_through_a_hole(const mesh::SurfaceQuery& surface, const mesh::SurfacePoint& hit, const Aim& aim) {
    if (glm::dot(hit.normal, aim.ray.direction) <= 0) return false;
    constexpr int kRays = 64;
    constexpr double kSurrounded = 0.4, kGoldenAngle = 2.399963229728653;
    const Vec3 normal = facing(hit, aim);
    const Vec3 from = hit.position + 1e-5 * surface.mesh().bounds.diagonal() * normal;
    const Frame f = make_frame(from, normal);
    int backs = 0;
    for (int i = 0; i < kRays; ++i) {
        const double out = (i + 0.5) / kRays, turn = kGoldenAngle * i;
        const Vec3 direction =
            std::sqrt(out) * (std::cos(turn) * f.t + std::sin(turn) * f.b) + std::sqrt(1 - out) * f.n;
        const auto met = surface.ray(from, direction);
        if (met && glm::dot(met->normal, direction) > 0) ++backs;
    }
    return backs > kSurrounded * kRays;
}

// The level of what lies round a gap under the aim; nothing where there is none. `centre`: metres to the aim's own hit.
std::optional<AimedSurface> LevelledView::find_gap(const Aim& aim, double centre) const {
    struct Pair {
        double depth;
        Vec3 normal;
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < kPairs; ++i) {
        const double angle = std::numbers::pi * i / kPairs;
        const Vec3 side = reach_ * (std::cos(angle) * aim.view_right + std::sin(angle) * aim.view_up);
        Aim one = aim, other = aim;
        one.ray.origin += side;
        other.ray.origin -= side;
        const auto a = aim_at(surface_, one), b = aim_at(surface_, other);
        if (!a || !b) continue;
        // On one surface, flat or evenly bent: each lies as far out of the other's plane. Else it is a rim or a step.
        const Vec3 na = facing(*a, aim), nb = facing(*b, aim), chord = b->position - a->position;
        const double out_a = glm::dot(na, chord), out_b = glm::dot(nb, chord);
        if (std::abs(out_a + out_b) < kShallow * reach_ && std::abs(out_a) < kBent * reach_)
            pairs.push_back({0.5 * (a->distance + b->distance), na + nb});
    }
    if (pairs.size() < kAgreeing) return std::nullopt;
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.depth < b.depth; });
    const double level = pairs[pairs.size() / 2].depth;
    Vec3 normal(0);
    std::size_t agree = 0;
    for (const Pair& pair : pairs)
        if (std::abs(pair.depth - level) < kShallow * reach_) normal += pair.normal, ++agree;
    const bool gap = agree >= kAgreeing && level < centre - kShallow * reach_ &&
                     glm::dot(normal, -aim.ray.direction) > kSlanting * glm::length(normal);
    if (!gap) return std::nullopt;
    return AimedSurface{.position = aim.ray.origin + level * aim.ray.direction,
                        .normal = glm::normalize(normal),
                        .distance = level,
                        .bridged = true};
}

std::optional<AimedSurface> LevelledView::find(const Aim& aim) const {
    const auto hit = aim_at(surface_, aim);
    if (const auto gap = find_gap(aim, hit ? hit->distance : std::numeric_limits<double>::infinity())) return gap;
    if (!hit) return std::nullopt;
    AimedSurface found{.position = hit->position, .normal = normal(aim, *hit), .distance = hit->distance};
    found.back = glm::dot(hit->normal, aim.ray.direction) > 0;
    found.inside = is_through_a_hole(surface_, *hit, aim);
    return found;
}

Vec3 LevelledView::normal(const Aim& aim, const mesh::SurfacePoint& hit) const {
    const double furthest = kSameSurface * steady_;
    Vec3 mean = facing(hit, aim);
    const Vec3 own = mean;
    for (int i = 0; i < 2 * kPairs && furthest > 0; ++i)
        for (const double part : {0.5, 1.0}) {
            const double angle = std::numbers::pi * i / kPairs;
            Aim beside = aim;
            beside.ray.origin += part * steady_ * (std::cos(angle) * aim.view_right + std::sin(angle) * aim.view_up);
            const auto at = aim_at(surface_, beside);
            const double away = at ? glm::distance(at->position, hit.position) / furthest : 1;
            if (away < 1) mean += part * (1 - away * away) * facing(*at, aim);
        }
    if (!(glm::length(mean) > 1e-6)) return own;
    mean = glm::normalize(mean);
    const double angle = std::acos(std::clamp(glm::dot(own, mean), -1.0, 1.0));
    return glm::normalize(glm::mix(own, mean, smooth_step((angle - kWall) / (kLip - kWall))));
}

}  // namespace tuft::stroke
