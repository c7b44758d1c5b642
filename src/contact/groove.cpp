#include "contact/groove.h"

#include <algorithm>
#include <utility>

#include "brush/rod/wedge.h"

namespace tuft::contact {
namespace {

constexpr double kAlike = 0.87;    // cos 30°
constexpr double kOpposed = -0.3;  // cos 107°

/// Height from which the wall of a groove is none for a node of the given radius, metres.
double reach_of(double radius) {
    return 2 * radius + 1e-3;
}

/// Height over a plane or an edge, and the direction in which it grows.
brush::Distance height_and_slope(const brush::ContactPlane& plane, const Vec3& p) {
    if (plane.beyond_normal == Vec3{0}) return {glm::dot(p - plane.origin, plane.normal), plane.normal};
    return brush::edge_distance({{plane.origin, plane.beyond_origin}, {plane.normal, plane.beyond_normal}}, 0, p);
}

/// The contact with the wall of `known` that faces `nearest`.
NodeContact find_wall(const mesh::SurfaceQuery& surface, const Vec3& node, const NodeContact& nearest,
                      const brush::ContactPlane& known, double within, const NodeContactOptions& options) {
    constexpr double kClear = 3e-4;  // m before both walls: behind them, or at the bottom, the nearest wall is any
    constexpr double kReach = 1e-3;  // m; more than a wall's curvature takes it off its plane from sample to sample
    constexpr double kNearer = 0.4;  // of the height: from there the wall is nearest
    constexpr int kPasses = 6;
    brush::Distance d = height_and_slope(known, node);
    if (d.z > within) return {};
    Vec3 p = node;
    for (int i = 0; i < kPasses; ++i) {
        const double height = glm::dot(p - nearest.plane.origin, nearest.plane.normal);
        if (height >= options.lift && d.z >= options.lift) break;
        p += std::max(0.0, kClear - height) * nearest.plane.normal;
        d = height_and_slope(known, p);
        p += std::max(0.0, kClear - d.z) * d.slope;
        d = height_and_slope(known, p);
    }
    const double near = std::max(options.lift, kNearer * d.z);
    p += (near - d.z) * d.slope;
    NodeContactOptions search = options;
    search.reach = near + kReach;
    const NodeContact wall = find_node_contact(surface, {.node = p, .from = p, .side = nearest.side}, search);
    const bool found = wall.triangle != kNone && glm::dot(wall.plane.normal, d.slope) > kAlike;
    return found && face_each_other(nearest, wall) ? wall : NodeContact{};
}

}  // namespace

double NodeWalls::height(const Vec3& p) const {
    const double z = brush::height_over(own.wedge, p);
    return in_groove() ? std::min(z, brush::height_over(across.wedge, p)) : z;
}

bool face_each_other(const NodeContact& a, const NodeContact& b) {
    if (a.triangle == kNone || b.triangle == kNone || glm::dot(a.plane.normal, b.plane.normal) > kOpposed) return false;
    constexpr double kFlat = 0.05;  // sine of an angle that counts as none
    const Vec3 path = b.plane.origin - a.plane.origin;
    const double before_a = glm::dot(path, a.plane.normal), before_b = -glm::dot(path, b.plane.normal);
    const double flat = kFlat * glm::length(path);
    return std::min(before_a, before_b) > -flat && std::max(before_a, before_b) > flat;
}

NodeWalls find_walls(const mesh::SurfaceQuery& surface, const Vec3& node, const NodeContact& nearest, double radius,
                     const NodeWalls& known, const NodeContactOptions& options) {
    if (nearest.triangle == kNone || !known.in_groove()) return {nearest, {}};
    const NodeContact across = find_wall(surface, node, nearest, known.across.wedge, reach_of(radius), options);
    if (across.triangle != kNone) return {nearest, across};
    const NodeContact own = find_wall(surface, node, nearest, known.own.wedge, reach_of(radius), options);
    if (own.triangle != kNone) return {own, nearest};
    return {nearest, {}};
}

namespace {

/// Calls that wall the nodes' own on which neighbours in one groove lie: hair has contact points between its nodes on
/// these alone. While both walls are about as far they stay what they are.
void choose_own_walls(std::span<NodeWalls> walls, std::span<const Vec3> nodes, std::span<const double> radii) {
    constexpr double kFarther = 1.5, kFar = 2e-4;  // of the other's distance, and metres
    for (std::size_t first = 0, end = 0; first < walls.size(); first = end + 1) {
        double own = 0, across = 0;  // from the hair's sides, all together
        for (end = first; end < walls.size() && walls[end].in_groove(); ++end) {
            own += std::max(0.0, brush::height_over(walls[end].own.wedge, nodes[end]) - radii[end]);
            across += std::max(0.0, brush::height_over(walls[end].across.wedge, nodes[end]) - radii[end]);
        }
        if (own <= kFarther * across + kFar) continue;
        for (std::size_t i = first; i < end; ++i) std::swap(walls[i].own, walls[i].across);
    }
}

}  // namespace

Recycled<NodeWalls> find_chain_walls(const mesh::SurfaceQuery& surface, const NodeChains& chains,
                                     const NodeContactOptions& options) {
    Recycled<NodeWalls> out(chains.nearest.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i].own = chains.nearest[i];
    if (chains.known.size() != chains.radii.size() || out.size() < chains.radii.size()) return out;
    std::size_t first = 0;
    for (const std::size_t length : chains.lengths) {
        const std::size_t end = first + length;
        for (std::size_t i = end; i-- > first;) {
            const NodeWalls* from = &chains.known[i];
            if (!from->in_groove() && i + 1 < end) from = &out[i + 1];
            if (!from->in_groove() && i > first) from = &chains.known[i - 1];
            out[i] = find_walls(surface, chains.nodes[i], chains.nearest[i], chains.radii[i], *from, options);
        }
        choose_own_walls(std::span(out).subspan(first, length), chains.nodes.subspan(first, length),
                         chains.radii.subspan(first, length));
        first = end;
    }
    return out;
}

bool is_root(std::span<const std::size_t> lengths, std::size_t node) {
    std::size_t end = 0;
    for (const std::size_t length : lengths)
        if (end += length; node < end) return node + 1 == end;
    return true;
}

NodeWalls update_walls(const NodeWalls& before, const NodeContact& nearest, const Vec3& node, double radius,
                       const NodeWalls* inboard) {
    const auto reached = [&](const NodeContact& wall) {
        return face_each_other(nearest, wall) && brush::height_over(wall.wedge, node) < reach_of(radius);
    };
    if (before.in_groove() && reached(before.across)) return {nearest, before.across};
    if (!reached(before.own)) return {nearest, {}};
    NodeWalls out{before.own, nearest};
    const auto like_inboard = [&](const NodeContact& c) { return glm::dot(c.plane.normal, inboard->own.plane.normal); };
    if (!before.in_groove() && inboard && inboard->in_groove() && like_inboard(nearest) > like_inboard(before.own))
        std::swap(out.own, out.across);
    return out;
}

}  // namespace tuft::contact
