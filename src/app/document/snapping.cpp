#include "app/document/snapping.h"

#include <algorithm>
#include <cmath>

namespace tuft::app {
namespace {

using stroke::SnapPlane;

constexpr int kGuidePoints = 48;

/// A plane that is near, and the middle of the drawing that it belongs to.
struct NearPlane {
    SnapPlane plane;
    std::optional<Vec3> from;
    double distance = 0;  ///< metres
};

/// Planes within reach, the nearest first.
std::vector<NearPlane> planes_near(const Vec3& p, const SnapTargets& targets, double reach) {
    std::vector<NearPlane> near;
    const auto add = [&](const SnapPlane& plane, const std::optional<Vec3>& from) {
        const double distance = std::abs(plane.distance(p));
        if (distance <= reach) near.push_back({plane, from, distance});
    };
    for (const SnapPlane& plane : targets.planes) add(plane, std::nullopt);
    for (const stroke::Placement& other : targets.placements) {
        add({other.origin, other.right}, other.origin);
        add({other.origin, other.down}, other.origin);
    }
    std::ranges::stable_sort(near, {}, &NearPlane::distance);
    return near;
}

/// The points of the surface nearest to a straight line, in the plane.
std::vector<Vec3> line_on_surface(const mesh::SurfaceQuery& surface, const SnapPlane& plane, const Vec3& from,
                                  const Vec3& to) {
    std::vector<Vec3> line;
    const double reach = std::max(0.25 * glm::distance(from, to), 1e-3);
    for (int i = 0; i <= kGuidePoints; ++i) {
        const Vec3 p = glm::mix(from, to, static_cast<double>(i) / kGuidePoints);
        if (const auto on = stroke::surface_point_in_plane(surface, p, plane, reach)) line.push_back(on->position);
    }
    return line;
}

std::vector<Vec3> guide_of(const mesh::SurfaceQuery& surface, const NearPlane& near, const mesh::SurfacePoint& at) {
    if (near.from) return line_on_surface(surface, near.plane, *near.from, at.position);
    const Vec3 along = glm::cross(near.plane.normal, at.normal);
    if (!(glm::length(along) > 1e-6)) return {};
    const Vec3 half = 0.15 * surface.mesh().bounds.diagonal() * glm::normalize(along);
    return line_on_surface(surface, near.plane, at.position - half, at.position + half);
}

/// The point in two planes: of their line the one nearest to the surface.
std::optional<mesh::SurfacePoint> point_in_both(const mesh::SurfaceQuery& surface, const Vec3& p,
                                                const SnapPlane& first, const SnapPlane& second, double reach) {
    constexpr int kSteps = 60;
    constexpr double kExact = 1e-6;  // metres
    if (std::abs(glm::dot(first.normal, second.normal)) > 0.9) return std::nullopt;
    Vec3 at = p;
    for (int step = 0; step < kSteps; ++step) {
        const auto on = stroke::surface_point_in_plane(surface, at, first, reach);
        if (!on || glm::distance(on->position, p) > reach) return std::nullopt;
        if (std::abs(second.distance(on->position)) <= kExact) return on;
        at = on->position - second.distance(on->position) * second.normal;
    }
    return std::nullopt;
}

}  // namespace

SnapTargets snap_targets(const stroke::Symmetry& symmetry, const Box& model,
                         std::span<const stroke::Placement> placements) {
    SnapTargets targets;
    const bool mirrors[] = {symmetry.mirror_x, symmetry.mirror_y, symmetry.mirror_z};
    const bool any = mirrors[0] || mirrors[1] || mirrors[2];
    for (int k = 0; k < 3; ++k) {
        Vec3 normal(0);
        normal[k] = 1;
        if (any ? mirrors[k] : k < 2) targets.planes.push_back({any ? symmetry.centre : model.centre(), normal});
    }
    for (const stroke::Placement& p : placements)
        if (std::ranges::none_of(targets.placements, [&](const stroke::Placement& known) {
                return known.origin == p.origin && known.right == p.right && known.down == p.down;
            }))
            targets.placements.push_back(p);
    return targets;
}

std::optional<SnappedPlace> snap(const mesh::SurfaceQuery& surface, const Vec3& p, const SnapTargets& targets,
                                 double reach) {
    const std::vector<NearPlane> near = planes_near(p, targets, reach);
    for (std::size_t i = 0; i < near.size(); ++i) {
        const auto at = stroke::surface_point_in_plane(surface, p, near[i].plane, 2 * reach);
        if (!at) continue;
        for (std::size_t k = i + 1; k < near.size(); ++k)
            if (const auto both = point_in_both(surface, p, near[i].plane, near[k].plane, 2 * reach))
                return SnappedPlace{*both, {guide_of(surface, near[i], *both), guide_of(surface, near[k], *both)}};
        return SnappedPlace{*at, {guide_of(surface, near[i], *at)}};
    }
    return std::nullopt;
}

}  // namespace tuft::app
