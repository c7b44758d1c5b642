#include "contact/node_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/ease.h"

namespace tuft::contact {
namespace {

/// Normal of the plane under a point at `off` from its closest point q: the smooth
/// normal, and over a crease, where the two differ by more than shading does, the direction of
/// `off`.
Vec3 plane_normal(const mesh::SurfacePoint& q, double side, const Vec3& off, double lift) {
    const Vec3 n = side * q.normal;
    const double d = glm::length(off);
    if (d <= lift) return n;
    const Vec3 direction = off / d;
    const double cosine = glm::dot(direction, n);
    constexpr double kNearlySame = 0.985, kApart = 0.90;  // 10° and 26°
    const double w =
        smooth_step((kNearlySame - cosine) / (kNearlySame - kApart)) * smooth_step((d - lift) / (4 * lift));
    if (w <= 0 || cosine < -0.5) return n;
    return glm::normalize((1 - w) * n + w * direction);
}

/// Unit normal of triangle t, smooth as shading has it, at weight w between its corners k and l.
Vec3 corner_normal(const mesh::TriangleMesh& mesh, std::uint32_t t, int k, int l, double w) {
    const Vec3 n = (1 - w) * Vec3(mesh.corner_normals[3 * t + k]) + w * Vec3(mesh.corner_normals[3 * t + l]);
    const double size = glm::length(n);
    return size > 1e-9 ? n / size : n;
}

/// Corners of the triangle beyond the edge of triangle t from its corner k on: those that are its corners k and k + 1,
/// and the third; −1: none.
struct CornersBeyond {
    int a = -1, b = -1, far = -1;
};

CornersBeyond corners_beyond(const mesh::TriangleMesh& mesh, std::uint32_t t, int k) {
    const auto &own = mesh.triangles[t], &of = mesh.triangles[mesh.neighbours[3 * t + k]];
    CornersBeyond out;
    for (int i = 0; i < 3; ++i) (of[i] == own[k] ? out.a : of[i] == own[(k + 1) % 3] ? out.b : out.far) = i;
    return out;
}

/// Whether both faces beside the edge of triangle t from its corner k on have the same normals along it.
bool shares_normals(const mesh::TriangleMesh& mesh, std::uint32_t t, int k, const CornersBeyond& beyond) {
    const std::uint32_t other = mesh.neighbours[3 * t + k];
    const auto& normal = mesh.corner_normals;
    return beyond.a >= 0 && beyond.b >= 0 && normal[3 * t + k] == normal[3 * other + beyond.a] &&
           normal[3 * t + (k + 1) % 3] == normal[3 * other + beyond.b];
}

/// A point of a sharp convex edge and the normal of the face beyond it.
struct SharpEdge {
    Vec3 origin{0}, beyond{0};
    double distance = 0;  // metres from where it was looked for
};

/// The edge of triangle t from its corner k on, where it is sharp and convex: the point of it
/// nearest to q.
std::optional<SharpEdge> sharp_edge(const mesh::TriangleMesh& mesh, std::uint32_t t, int k, const Vec3& q) {
    const std::uint32_t other = mesh.neighbours[3 * t + k];
    if (other == kNone) return {};
    const CornersBeyond beyond = corners_beyond(mesh, t, k);
    const auto [a, b, far] = beyond;
    if (a < 0 || b < 0 || far < 0) return {};
    // Both faces share their normals on a smooth surface: nothing to compute.
    if (shares_normals(mesh, t, k, beyond)) return {};
    const int l = (k + 1) % 3;
    const Vec3 from = mesh.position(t, k), edge = mesh.position(t, l) - from;
    const double w = std::clamp(glm::dot(q - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    const Vec3 own = corner_normal(mesh, t, k, l, w);
    constexpr double kSharp = 0.9;  // cos 26°
    if (glm::dot(own, corner_normal(mesh, other, a, b, w)) > kSharp) return {};
    if (glm::dot(mesh.position(other, far) - from, face_normal(mesh, t)) >= 0) return {};
    const Vec3 nearest = from + w * edge;
    return SharpEdge{nearest, face_normal(mesh, other), glm::length(nearest - q)};
}

constexpr double kEdgeReach = 1e-3;  // metres; more than a node goes from step to step

/// Triangles that a search met, in their order.
template <int most>
class Met {
  public:
    explicit Met(std::uint32_t first) : triangles_{first} {}
    int count() const { return count_; }
    std::uint32_t operator[](int i) const { return triangles_[i]; }
    bool contains(std::uint32_t t) const {
        return std::find(triangles_.begin(), triangles_.begin() + count_, t) != triangles_.begin() + count_;
    }
    /// Returns false where there is no room.
    bool add(std::uint32_t t) {
        if (count_ == most) return false;
        triangles_[count_++] = t;
        return true;
    }

  private:
    std::array<std::uint32_t, most> triangles_;
    int count_ = 1;
};

/// The sharp convex edge nearest to the surface point q within reach, over triangles that
/// hang together with q's without such an edge between them.
std::optional<SharpEdge> find_edge(const mesh::TriangleMesh& mesh, const mesh::SurfacePoint& q) {
    Met<24> met(q.triangle);
    std::optional<SharpEdge> best;
    for (int i = 0; i < met.count(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t next = mesh.neighbours[3 * met[i] + k];
            if (next == kNone || met.contains(next)) continue;
            const Vec3 from = mesh.position(met[i], k), edge = mesh.position(met[i], (k + 1) % 3) - from;
            const Vec3 to_q = q.position - from;
            const double length2 = glm::dot(edge, edge), along = std::clamp(glm::dot(to_q, edge), 0.0, length2);
            // Squared distance from the edge, times its squared length.
            if (length2 * glm::dot(to_q, to_q) + along * (along - 2 * glm::dot(to_q, edge)) >
                kEdgeReach * kEdgeReach * length2)
                continue;
            if (const auto sharp = sharp_edge(mesh, met[i], k, q.position)) {
                if (!best || sharp->distance < best->distance) best = sharp;
            } else {
                met.add(next);
            }
        }
    }
    return best;
}

/// The point `lift` before the wall that a node lies behind. Along the smooth normal: with that of the face, nodes
/// below an edge would come to lie before either of its faces, by rounding, apart by their depth times its angle.
Vec3 before_wall(const mesh::SurfacePoint& wall, const Vec3& node, double side, double lift) {
    const Vec3 n = side * wall.face_normal, smooth = side * wall.normal;
    const double depth = glm::dot(wall.position - node, n), cosine = glm::dot(smooth, n);
    constexpr double kNear = 0.7;  // 45°: farther apart, the one is not that of the surface there
    return cosine > kNear ? node + (depth / cosine + lift) * smooth : node + (depth + lift) * n;
}

/// Whether the surface point q lies on an edge from whose other face `off` leads outwards.
bool before_other_face(const mesh::TriangleMesh& mesh, const mesh::SurfacePoint& q, double side, const Vec3& off) {
    const double weight[3] = {1 - q.b1 - q.b2, q.b1, q.b2};
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh.neighbours[3 * q.triangle + k];
        if (weight[(k + 2) % 3] > 1e-9 || other == kNone) continue;
        if (side * glm::dot(off, face_normal(mesh, other)) >= 0) return true;
    }
    return false;
}

/// Whether the search of `find_edge` finds nothing from any point of triangle t. It may say no where that is so.
bool is_smooth_round(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    constexpr int kMost = 128;  // triangles; on finer meshes their number takes longer than `find_edge`
    const Vec3 middle = (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3.0;
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach = std::max(reach, glm::length(mesh.position(t, k) - middle));
    reach += 1.001 * kEdgeReach;
    const double area = 0.5 * glm::length(glm::cross(mesh.position(t, 1) - mesh.position(t, 0),
                                                     mesh.position(t, 2) - mesh.position(t, 0)));
    if (std::numbers::pi * reach * reach > kMost * area) return false;  // about so many lie within reach
    Met<kMost> met(t);
    for (int i = 0; i < met.count(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t next = mesh.neighbours[3 * met[i] + k];
            if (next == kNone) continue;
            const Vec3 from = mesh.position(met[i], k), edge = mesh.position(met[i], (k + 1) % 3) - from;
            const double along = std::clamp(glm::dot(middle - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
            if (glm::length(from + along * edge - middle) > reach) continue;
            // Whether an edge is sharp depends on the place along it, but where both faces have the same normals.
            if (!shares_normals(mesh, met[i], k, corners_beyond(mesh, met[i], k))) return false;
            if (!met.contains(next) && !met.add(next)) return false;
        }
    }
    return true;
}

}  // namespace

bool SmoothTriangles::has_no_edge(const mesh::TriangleMesh& mesh, std::uint32_t triangle) {
    if (slot_.empty()) slot_.assign(kSlots, kNone);
    std::uint32_t& slot = slot_[triangle % kSlots];
    if (slot == kNone || slot / 2 != triangle) slot = 2 * triangle + (is_smooth_round(mesh, triangle) ? 0 : 1);
    return slot % 2 == 0;
}

NodeContact find_node_contact(const mesh::SurfaceQuery& surface, const NodeQuery& query,
                              const NodeContactOptions& options) {
    const Vec3& node = query.node;
    NodeContact out;
    out.outside = node;
    out.side = query.side;
    Vec3 front = node;
    bool behind = false;
    const Vec3 path = node - query.from;
    const double length = glm::length(path);
    if (length > 1e-9) {
        if (const auto wall = surface.ray(query.from, path / length, 0, length)) {
            out.side = glm::dot(wall->face_normal, path) < 0 ? 1 : -1;
            front = before_wall(*wall, node, out.side, options.lift);
            behind = true;
        }
    }
    const double within = query.known ? 1.000001 * glm::length(front - *query.known) + 1e-9 : options.reach;
    const auto q = surface.closest_point(front, std::min(within, options.reach));
    if (!q) return out;
    const Vec3 off = node - q->position;
    bool over_edge = false;  // in front of it, however its other face lies
    if (!behind && q->distance > options.lift) {
        const double most = -0.5 * q->distance;
        const bool from_back = out.side * glm::dot(off, q->face_normal) < most;
        if (from_back || out.side * glm::dot(off, q->normal) < most)
            over_edge = before_other_face(surface.mesh(), *q, out.side, off);
        if (from_back && !over_edge) out.side = -out.side;  // clearly in front of an open sheet's back
    }
    out.triangle = q->triangle;
    out.plane.origin = q->position;
    out.plane.normal = behind      ? out.side * q->normal
                       : over_edge ? off / q->distance
                                   : plane_normal(*q, out.side, off, options.lift);
    out.height = glm::dot(off, out.plane.normal);
    out.wedge = out.plane;
    const bool smooth = options.smooth && options.smooth->has_no_edge(surface.mesh(), q->triangle);
    if (const auto edge = smooth ? std::nullopt : find_edge(surface.mesh(), *q)) {
        // On the edge itself both faces are taken flat, so that it is the same from either.
        const Vec3& own = edge->distance < 1e-7 ? q->face_normal : q->normal;
        out.wedge = {q->position, out.side * own, edge->origin, out.side * edge->beyond};
    }
    if (out.height < options.lift) out.outside = node + (options.lift - out.height) * out.plane.normal;
    return out;
}

namespace {

/// Whether a node that was at `was` keeps its plane. Distances from the surface change no faster than the node. One
/// that was farther than `near` has no plane of its own.
bool keeps_plane(const NodeContact& before, const Vec3& was, const Vec3& node, double still, double near) {
    return before.triangle != kNone && before.height <= near && before.wedge.beyond_normal == Vec3{0} &&
           glm::length(node - was) <= still;
}

/// The contact of a node that moved to `node` and keeps its plane.
NodeContact moved_on(NodeContact contact, const Vec3& node, double lift) {
    const Vec3& n = contact.plane.normal;
    contact.height = glm::dot(node - contact.plane.origin, n);
    contact.outside = contact.height < lift ? node + (lift - contact.height) * n : node;
    return contact;
}

}  // namespace

Recycled<NodeContact> find_chain_contacts(const mesh::SurfaceQuery& surface, const NodeContact& root,
                                          std::span<const Vec3> nodes, double near, const NodeContactOptions& options,
                                          const KnownContacts& known) {
    Recycled<NodeContact> out(nodes.size());
    NodeContact last = root;
    Vec3 searched_at = root.outside;
    double clearance = root.triangle == kNone ? options.reach : root.height;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const Vec3& node = nodes[i];
        const double free = clearance - glm::length(node - searched_at);
        if (free > near) {
            out[i] = last;
            out[i].outside = node;
            out[i].height = free;
            continue;
        }
        const NodeContact* before = i < known.contacts.size() ? &known.contacts[i] : nullptr;
        if (before && i < known.nodes.size() && keeps_plane(*before, known.nodes[i], node, known.still, near)) {
            last = moved_on(*before, node, options.lift);
        } else {
            const Vec3* foot = nullptr;
            for (const NodeContact* hint : {&std::as_const(last), before}) {
                if (!hint || hint->triangle == kNone) continue;
                const Vec3& point = hint->plane.origin;
                if (!foot || glm::length(point - node) < glm::length(*foot - node)) foot = &point;
            }
            const Vec3& from = i + 1 < nodes.size() ? out[i + 1].outside : root.outside;
            last = find_node_contact(surface, {node, from, last.side, foot}, options);
        }
        out[i] = last;
        searched_at = last.outside;
        clearance = last.triangle == kNone ? options.reach : last.height;
    }
    return out;
}

Vec3 find_outside_point(const mesh::SurfaceQuery& surface, const Vec3& root, const Vec3& up,
                        const NodeContactOptions& options) {
    const auto q = surface.closest_point(root, options.reach);
    if (!q || glm::dot(root - q->position, q->face_normal) >= 0) return root;
    const auto exit = surface.ray(root, up, 0, 4 * options.reach);
    if (!exit || glm::dot(exit->face_normal, up) <= 0) return root;  // in front of an open sheet's back
    return exit->position + options.lift * exit->face_normal;
}

double depth_inside(const mesh::SurfaceQuery& surface, const Vec3& p) {
    const Box& box = surface.mesh().bounds;
    if (box.empty() || glm::any(glm::lessThan(p, box.lo)) || glm::any(glm::greaterThan(p, box.hi))) return 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec3 direction{0};
            direction[axis] = sign;
            const auto hit = surface.ray(p, direction);
            if (!hit || glm::dot(hit->face_normal, direction) <= 0) return 0;
        }
    const auto near = surface.closest_point(p);
    return near ? near->distance : 0;
}

}  // namespace tuft::contact
