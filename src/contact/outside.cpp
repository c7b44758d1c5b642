#include "contact/outside.h"

#include <algorithm>
#include <cmath>

namespace tuft::contact {
namespace {

double smooth(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

/// Normal of the plane under a point that stands `off` from its closest point q: the smooth
/// normal, and over a crease, where the two differ by more than shading does, the direction of
/// `off`.
Vec3 plane_normal(const mesh::SurfacePoint& q, double side, const Vec3& off, double lift) {
    const Vec3 n = side * q.normal;
    const double d = glm::length(off);
    if (d <= lift) return n;
    const Vec3 direction = off / d;
    const double cosine = glm::dot(direction, n);
    constexpr double kAlike = 0.985, kApart = 0.90;  // 10° and 26°
    const double w =
        smooth((kAlike - cosine) / (kAlike - kApart)) * smooth((d - lift) / (4 * lift));
    if (w <= 0 || cosine < -0.5) return n;
    return glm::normalize((1 - w) * n + w * direction);
}

}  // namespace

Stand stand_from(const mesh::SurfaceQuery& surface, const Vec3& from, double side, const Vec3& p,
                 const StandOptions& options, const Vec3* known) {
    Stand out;
    out.outside = p;
    out.side = side;
    Vec3 front = p;
    bool behind = false;
    const Vec3 way = p - from;
    const double length = glm::length(way);
    if (length > 1e-9) {
        if (const auto wall = surface.ray(from, way / length, 0, length)) {
            out.side = glm::dot(wall->face_normal, way) < 0 ? 1 : -1;
            const Vec3 n = out.side * wall->face_normal;
            front = p + (glm::dot(wall->position - p, n) + options.lift) * n;
            behind = true;
        }
    }
    const double within = known ? 1.000001 * glm::length(front - *known) + 1e-9 : options.reach;
    const auto q = surface.closest_point(front, std::min(within, options.reach));
    if (!q) return out;
    const Vec3 off = p - q->position;
    if (!behind) {
        // Clearly in front of an open sheet's back.
        const double over = out.side * glm::dot(off, q->face_normal);
        if (over < -0.5 * q->distance && q->distance > options.lift) out.side = -out.side;
    }
    out.triangle = q->triangle;
    out.plane.origin = q->position;
    out.plane.normal =
        behind ? out.side * q->normal : plane_normal(*q, out.side, off, options.lift);
    out.height = glm::dot(off, out.plane.normal);
    if (out.height < options.lift) out.outside = p + (options.lift - out.height) * out.plane.normal;
    return out;
}

std::vector<Stand> stand_along(const mesh::SurfaceQuery& surface, const Stand& root,
                               std::span<const Vec3> points, double near,
                               const StandOptions& options, std::span<const Stand> before) {
    std::vector<Stand> out(points.size());
    Stand last = root;
    Vec3 looked_up = root.outside;
    double clear = root.triangle == kNone ? options.reach : root.height;
    for (std::size_t i = points.size(); i-- > 0;) {
        const Vec3& p = points[i];
        const double free = clear - glm::length(p - looked_up);
        if (free > near) {
            out[i] = last;
            out[i].outside = p;
            out[i].height = free;
            continue;
        }
        const Stand& hint = i < before.size() ? before[i] : last;
        const Vec3& from = i + 1 < points.size() ? out[i + 1].outside : root.outside;
        last = stand_from(surface, from, last.side, p, options,
                          hint.triangle != kNone ? &hint.plane.origin : nullptr);
        out[i] = last;
        looked_up = last.outside;
        clear = last.triangle == kNone ? options.reach : last.height;
    }
    return out;
}

Vec3 find_outside(const mesh::SurfaceQuery& surface, const Vec3& root, const Vec3& up,
                  const StandOptions& options) {
    const auto q = surface.closest_point(root, options.reach);
    if (!q || glm::dot(root - q->position, q->face_normal) >= 0) return root;
    const auto exit = surface.ray(root, up, 0, 4 * options.reach);
    if (!exit || glm::dot(exit->face_normal, up) <= 0)
        return root;  // in front of an open sheet's back
    return exit->position + options.lift * exit->face_normal;
}

}  // namespace tuft::contact
