#include "stroke/placement/surface_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "stroke/placement/projection.h"

namespace tuft::stroke {

namespace {

constexpr std::array<std::pair<SurfaceMapping, std::string_view>, 3> kMappings{
    {{SurfaceMapping::wrap, "wrap"}, {SurfaceMapping::drape, "drape"}, {SurfaceMapping::project, "project"}}};

using mesh::SurfacePoint;
using mesh::TriangleMesh;

/// Keeps points this part of an edge away from its ends, so that the line never has to
/// choose among all triangles round a vertex. Far below the size of an atom on any model.
constexpr double kOffVertex = 1e-7;

struct Corners {
    Vec3 p[3];
    Vec3 normal;
};

Corners corners(const TriangleMesh& mesh, std::uint32_t triangle) {
    Corners c{{mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)}, {}};
    c.normal = glm::normalize(glm::cross(c.p[1] - c.p[0], c.p[2] - c.p[0]));
    return c;
}

/// Change of the three barycentric weights per metre along `direction` in the triangle's plane.
std::array<double, 3> weight_rates(const Corners& c, const Vec3& direction) {
    const Vec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0];
    const double a = glm::dot(e1, e1), b = glm::dot(e1, e2), d = glm::dot(e2, e2);
    const double u = glm::dot(direction, e1), v = glm::dot(direction, e2);
    const double det = a * d - b * b;
    const double r1 = (d * u - b * v) / det, r2 = (a * v - b * u) / det;
    return {-r1 - r2, r1, r2};
}

/// Where the ray meets the plane of the triangle that was hit, in double.
SurfacePoint refine_hit(const TriangleMesh& mesh, const SurfacePoint& hit, const Vec3& origin, const Vec3& direction) {
    const Corners c = corners(mesh, hit.triangle);
    const double slope = glm::dot(direction, c.normal);
    if (std::abs(slope) < 1e-3) return hit;  // grazing: the plane says little
    const Vec3 p = origin + (glm::dot(c.p[0] - origin, c.normal) / slope) * direction;
    const auto w = weight_rates(c, p - c.p[0]);
    return mesh::surface_point(mesh, hit.triangle, std::clamp(w[1], 0.0, 1.0),
                               std::clamp(w[2], 0.0, 1.0 - std::clamp(w[1], 0.0, 1.0)));
}

void check(const StrokeSamples& trace) {
    if (!trace.flat) throw Error("a trace in space cannot be mapped onto the model");
    const auto finite = [](const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    const Placement& p = trace.placement;
    if (!finite(p.origin) || !finite(p.right) || !finite(p.down))
        throw Error("the placement of a stroke is not finite");
    const double area = glm::length(glm::cross(p.right, p.down));
    if (!(area > 1e-6 * glm::length(p.right) * glm::length(p.down)) || !(area > 0))
        throw Error("the placement of a stroke has directions that are zero or parallel");
    for (const StrokeSample& s : trace.samples)
        if (!finite(s.position) || !std::isfinite(s.time) || !std::isfinite(s.pressure) || !std::isfinite(s.tilt.x) ||
            !std::isfinite(s.tilt.y) || !std::isfinite(s.roll))
            throw Error("a stroke has a sample that is not finite");
}

SurfaceTrace map_wrapped(const mesh::SurfaceQuery& query, const StrokeSamples& trace) {
    const auto start = query.closest_point(trace.placement.origin);
    if (!start) throw Error("there is no surface to map a stroke onto");
    SurfaceTrace mapped;
    mapped.origin_gap = start->distance;
    const Axes axes = axes_across(start->normal, trace.placement.right, trace.placement.down);
    const Vec3 right0 = parallel_transport(axes.right, start->normal, start->face_normal);
    const Vec3 down0 = parallel_transport(axes.down, start->normal, start->face_normal);

    mapped.samples.reserve(trace.samples.size());
    for (const StrokeSample& s : trace.samples) {
        check_interrupt();
        SurfaceSample out = hand_data(s);
        const double length = std::hypot(s.position.x, s.position.y);
        const Vec3 heading = length > 0 ? (s.position.x * right0 + s.position.y * down0) / length : right0;
        const StraightestGeodesic line = trace_geodesic(query.mesh(), *start, heading, length);
        out.on = line.end;
        out.on.distance = 0;
        out.position = line.end.position + line.beyond * line.direction;
        out.on_surface = line.beyond == 0;
        mapped.missed += !out.on_surface;
        // The frame keeps its angle to the line.
        const Vec3 side0 = glm::cross(start->face_normal, heading);
        const Vec3 side1 = glm::cross(line.end.face_normal, line.direction);
        const auto transport = [&](const Vec3& v) {
            const Vec3 flat = glm::dot(v, heading) * line.direction + glm::dot(v, side0) * side1;
            return parallel_transport(flat, line.end.face_normal, line.end.normal);
        };
        out.normal = line.end.normal;
        const Axes here = axes_across(out.normal, transport(right0), transport(down0));
        out.right = here.right;
        out.down = here.down;
        mapped.samples.push_back(out);
    }
    return mapped;
}

}  // namespace

std::string_view surface_mapping_name(SurfaceMapping mapping) {
    return std::find_if(kMappings.begin(), kMappings.end(), [=](const auto& l) { return l.first == mapping; })->second;
}

std::optional<SurfaceMapping> surface_mapping_named(std::string_view name) {
    for (const auto& [mapping, known] : kMappings)
        if (known == name) return mapping;
    return std::nullopt;
}

Axes axes_across(const Vec3& normal, const Vec3& right, const Vec3& down) {
    Vec3 r = right - glm::dot(right, normal) * normal;
    Vec3 d = down - glm::dot(down, normal) * normal;
    const double sign = glm::dot(glm::cross(d, r), normal) < 0 ? -1.0 : 1.0;
    if (glm::dot(r, r) >= glm::dot(d, d)) {
        r = glm::normalize(r);
        d = sign * glm::cross(r, normal);
    } else {
        d = glm::normalize(d);
        r = sign * glm::cross(normal, d);
    }
    return {r, d};
}

Vec3 into_plane(const Vec3& direction, const Vec3& normal) {
    const Vec3 d = direction - glm::dot(direction, normal) * normal;
    return glm::normalize(d);
}

SurfaceSample hand_data(const StrokeSample& s) {
    SurfaceSample mapped;
    mapped.time = s.time;
    mapped.pressure = std::clamp(s.pressure, 0.0, 1.0);
    mapped.tilt = s.tilt;
    mapped.roll = s.roll;
    return mapped;
}

std::optional<SurfacePoint> exact_ray(const mesh::SurfaceQuery& query, const Vec3& origin, const Vec3& direction,
                                      double t_max) {
    const auto hit = query.ray(origin, direction, 0, t_max);
    if (!hit) return hit;
    return refine_hit(query.mesh(), *hit, origin, direction);
}

StraightestGeodesic trace_geodesic(const TriangleMesh& mesh, const SurfacePoint& start, const Vec3& direction,
                                   double length) {
    std::uint32_t triangle = start.triangle;
    Corners c = corners(mesh, triangle);
    Vec3 d = into_plane(direction, c.normal);
    std::array<double, 3> w{1 - start.b1 - start.b2, start.b1, start.b2};
    for (double& x : w) x = std::max(x, kOffVertex);
    const double sum = w[0] + w[1] + w[2];
    for (double& x : w) x /= sum;

    int entered = -1;  // corner opposite the edge the line came in by
    double left = length;
    const std::size_t limit = 4 * mesh.n_triangles() + 1000;
    StraightestGeodesic out;
    for (std::size_t crossings = 0; left > 0; ++crossings) {
        const auto rate = weight_rates(c, d);
        int leave = -1;
        double reach = left;
        for (int k = 0; k < 3; ++k)
            if (k != entered && rate[k] < 0 && -w[k] / rate[k] < reach) {
                reach = std::max(0.0, -w[k] / rate[k]);
                leave = k;
            }
        for (int k = 0; k < 3; ++k) w[k] = std::max(0.0, w[k] + reach * rate[k]);
        left -= reach;
        if (leave < 0) break;

        const int i = (leave + 1) % 3, j = (leave + 2) % 3;
        const std::uint32_t next = mesh.neighbours[3 * triangle + i];
        w[leave] = 0;
        const double along = std::clamp(w[j] / (w[i] + w[j]), kOffVertex, 1 - kOffVertex);
        if (next == kNone || crossings >= limit) {
            w[i] = 1 - along;
            w[j] = along;
            out.beyond = left;
            break;
        }
        const Vec3 edge = glm::normalize(c.p[j] - c.p[i]);
        const double forward = glm::dot(d, edge), across = glm::dot(d, glm::cross(edge, c.normal));
        const std::uint32_t vertex_i = mesh.triangles[triangle][i];
        const auto& t = mesh.triangles[next];
        const int ni = static_cast<int>(std::find(t.begin(), t.end(), vertex_i) - t.begin());
        triangle = next;
        c = corners(mesh, triangle);
        d = glm::normalize(forward * edge + across * glm::cross(edge, c.normal));
        entered = (ni + 1) % 3;  // the neighbour runs along the edge the other way: j, i
        w[ni % 3] = 1 - along;
        w[(ni + 2) % 3] = along;
        w[entered] = 0;
    }
    const double total = w[0] + w[1] + w[2];
    out.end = mesh::surface_point(mesh, triangle, w[1] / total, w[2] / total);
    out.end.distance = length - out.beyond;
    out.direction = into_plane(d, out.end.face_normal);
    return out;
}

SurfaceTrace map_to_surface(const mesh::SurfaceQuery& query, const StrokeSamples& trace, Drapes* shared) {
    check(trace);
    switch (trace.placement.mapping) {
        case SurfaceMapping::project:
            return map_projected(query, trace);
        case SurfaceMapping::drape:
            return map_draped(query, trace, shared);
        case SurfaceMapping::wrap:
            break;
    }
    return map_wrapped(query, trace);
}

}  // namespace tuft::stroke
