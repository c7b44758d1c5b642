#include "contact/planes_at_rest.h"

#include <algorithm>
#include <cmath>

namespace tuft::contact {
namespace {

/// The plane for a node that met `old` and came to rest where the surface is `now`. In a
/// concave corner, where it would be thrown from wall to wall, it gets both walls' bisector.
brush::ContactPlane refresh_plane(const brush::ContactPlane& old, const NodeContact& now, const Vec3& p,
                                  double radius) {
    const brush::ContactPlane& fresh = now.wedge;
    if (fresh.beyond_normal != Vec3{0} || old.beyond_normal != Vec3{0}) return fresh;
    const double z_old = glm::dot(p - old.origin, old.normal);
    constexpr double kCorner = 0.87;  // cos 30°
    if (glm::dot(old.normal, fresh.normal) > kCorner || z_old > 1.5 * radius) return fresh;
    const Vec3 sum = old.normal + fresh.normal;
    if (glm::dot(sum, sum) < 1.4) return fresh;  // the walls of a groove
    const Vec3 n = glm::normalize(sum);
    // Through the point where p would be in front of both.
    const double needed = std::max(-z_old, -now.height) / glm::dot(n, fresh.normal);
    return {p + needed * n, n};
}

}  // namespace

PlaneErrors find_plane_errors(const Recycled<NodeWalls>& walls, const NodesAtRest& rest) {
    const auto& [nodes, found, radii, lengths] = rest;
    PlaneErrors errors;
    errors.near.reserve(walls.size());
    for (std::size_t i = walls.size(); i-- > 0;) {
        const double z = walls[i].height(nodes[i]);
        const double height = brush::height_over(found[i].wedge, nodes[i]);
        if (std::min(z, height) > 2 * radii.at(i)) continue;
        errors.worst = std::max(errors.worst, std::abs(z - height));
        errors.near.push_back(i);
    }
    return errors;
}

void renew_walls(Recycled<NodeWalls>& walls, const Recycled<NodeWalls>& before, const Recycled<std::size_t>& near,
                 const NodesAtRest& rest) {
    const auto& [nodes, found, radii, lengths] = rest;
    for (const std::size_t i : near) {
        const NodeWalls* inboard = is_root(lengths, i) ? nullptr : &walls[i + 1];
        const NodeWalls& old = before[i];
        walls[i] = i < radii.trunk.size() ? update_walls(old, found[i], nodes[i], radii.trunk[i], inboard)
                                          : NodeWalls{found[i], {}};
        if (!walls[i].in_groove()) walls[i].own.wedge = refresh_plane(old.own.wedge, found[i], nodes[i], radii.at(i));
    }
}

}  // namespace tuft::contact
