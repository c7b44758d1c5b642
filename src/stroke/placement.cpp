#include "stroke/placement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "brush/sweep.h"
#include "core/error.h"

namespace tuft::stroke {

namespace {

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
    Corners c{{mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)},
              {}};
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

/// `direction` turned into the plane with the given unit normal, unit length.
Vec3 into_plane(const Vec3& direction, const Vec3& normal) {
    const Vec3 d = direction - glm::dot(direction, normal) * normal;
    return glm::normalize(d);
}

/// Right and down as an orthonormal pair across `normal`; right keeps its heading.
struct Axes {
    Vec3 right, down;
};

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

void check(const Trace& trace) {
    if (!trace.flat) throw Error("a trace in space cannot be laid onto the model");
    const auto finite = [](const Vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    const Placement& p = trace.placement;
    if (!finite(p.origin) || !finite(p.right) || !finite(p.down))
        throw Error("the placement of a stroke is not finite");
    const double area = glm::length(glm::cross(p.right, p.down));
    if (!(area > 1e-6 * glm::length(p.right) * glm::length(p.down)) || !(area > 0))
        throw Error("the placement of a stroke has directions that are zero or parallel");
    for (const TraceSample& s : trace.samples)
        if (!finite(s.position) || !std::isfinite(s.time) || !std::isfinite(s.pressure) ||
            !std::isfinite(s.tilt.x) || !std::isfinite(s.tilt.y))
            throw Error("a stroke has a sample that is not finite");
}

LaidSample hand_data(const TraceSample& s) {
    LaidSample laid;
    laid.time = s.time;
    laid.pressure = std::clamp(s.pressure, 0.0, 1.0);
    laid.tilt = s.tilt;
    return laid;
}

LaidTrace lay_wrapped(const mesh::SurfaceQuery& query, const Trace& trace) {
    const auto start = query.closest_point(trace.placement.origin);
    if (!start) throw Error("there is no surface to lay a stroke on");
    LaidTrace laid;
    laid.origin_gap = start->distance;
    const Axes axes = axes_across(start->normal, trace.placement.right, trace.placement.down);
    const Vec3 right0 = parallel_transport(axes.right, start->normal, start->face_normal);
    const Vec3 down0 = parallel_transport(axes.down, start->normal, start->face_normal);

    laid.samples.reserve(trace.samples.size());
    for (const TraceSample& s : trace.samples) {
        LaidSample out = hand_data(s);
        const double length = std::hypot(s.position.x, s.position.y);
        const Vec3 heading =
            length > 0 ? (s.position.x * right0 + s.position.y * down0) / length : right0;
        const Walk line = walk(query.mesh(), *start, heading, length);
        out.on = line.end;
        out.on.distance = 0;
        out.position = line.end.position + line.beyond * line.direction;
        out.on_surface = line.beyond == 0;
        laid.missed += !out.on_surface;
        // The frame keeps its angle to the line.
        const Vec3 side0 = glm::cross(start->face_normal, heading);
        const Vec3 side1 = glm::cross(line.end.face_normal, line.direction);
        const auto carry = [&](const Vec3& v) {
            const Vec3 flat = glm::dot(v, heading) * line.direction + glm::dot(v, side0) * side1;
            return parallel_transport(flat, line.end.face_normal, line.end.normal);
        };
        out.normal = line.end.normal;
        const Axes here = axes_across(out.normal, carry(right0), carry(down0));
        out.right = here.right;
        out.down = here.down;
        laid.samples.push_back(out);
    }
    return laid;
}

/// Where the ray meets the plane of the triangle that was hit, in double.
SurfacePoint refine_hit(const TriangleMesh& mesh, const SurfacePoint& hit, const Vec3& origin,
                        const Vec3& direction) {
    const Corners c = corners(mesh, hit.triangle);
    const double slope = glm::dot(direction, c.normal);
    if (std::abs(slope) < 1e-3) return hit;  // grazing: the plane says little
    const Vec3 p = origin + (glm::dot(c.p[0] - origin, c.normal) / slope) * direction;
    const auto w = weight_rates(c, p - c.p[0]);
    return mesh::surface_point(mesh, hit.triangle, std::clamp(w[1], 0.0, 1.0),
                               std::clamp(w[2], 0.0, 1.0 - std::clamp(w[1], 0.0, 1.0)));
}

/// Gives samples whose ray met nothing the height and frame of the nearest one that hit.
void fill_misses(LaidTrace& laid, const std::vector<Vec3>& on_plane, const Vec3& outward) {
    std::vector<std::size_t> hits;
    for (std::size_t i = 0; i < laid.samples.size(); ++i)
        if (laid.samples[i].on_surface) hits.push_back(i);
    std::size_t next = 0;
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        LaidSample& s = laid.samples[i];
        if (s.on_surface) continue;
        if (hits.empty()) {
            s.position = on_plane[i];
            continue;
        }
        while (next < hits.size() && hits[next] < i) ++next;
        std::size_t from = next < hits.size() ? hits[next] : hits.back();
        if (next > 0 && next < hits.size() &&
            s.time - laid.samples[hits[next - 1]].time <= laid.samples[hits[next]].time - s.time)
            from = hits[next - 1];
        const LaidSample& near = laid.samples[from];
        s.on = near.on;
        s.normal = near.normal;
        s.right = near.right;
        s.down = near.down;
        s.position = on_plane[i] + glm::dot(near.position - on_plane[i], outward) * outward;
    }
}

LaidTrace lay_projected(const mesh::SurfaceQuery& query, const Trace& trace) {
    const Placement& place = trace.placement;
    const Vec3 outward = glm::normalize(glm::cross(place.down, place.right));
    const Axes axes = axes_across(outward, place.right, place.down);
    const Box& bounds = query.mesh().bounds;

    LaidTrace laid;
    if (const auto near = query.closest_point(place.origin)) laid.origin_gap = near->distance;
    std::vector<Vec3> on_plane;
    on_plane.reserve(trace.samples.size());
    laid.samples.reserve(trace.samples.size());
    for (const TraceSample& s : trace.samples) {
        LaidSample out = hand_data(s);
        const Vec3 p = place.origin + s.position.x * axes.right + s.position.y * axes.down;
        on_plane.push_back(p);
        const double above = glm::dot(bounds.centre() - p, outward) + bounds.diagonal();
        const Vec3 eye = p + above * outward;
        out.normal = outward;
        out.right = axes.right;
        out.down = axes.down;
        if (const auto hit = query.ray(eye, -outward)) {
            out.on = refine_hit(query.mesh(), *hit, eye, -outward);
            out.position = out.on.position;
            out.normal = out.on.normal;
            const Axes here = axes_across(out.normal, axes.right, axes.down);
            out.right = here.right;
            out.down = here.down;
        } else {
            out.on_surface = false;
            ++laid.missed;
        }
        laid.samples.push_back(out);
    }
    fill_misses(laid, on_plane, outward);
    return laid;
}

double lead_length(std::span<const Lead> table, double depth) {
    if (table.empty()) return 0;
    if (depth <= table.front().depth)
        return table.front().depth > 0 ? table.front().length * depth / table.front().depth
                                       : table.front().length;
    for (std::size_t i = 1; i < table.size(); ++i) {
        const Lead &a = table[i - 1], &b = table[i];
        if (depth <= b.depth)
            return a.length + (b.length - a.length) * (depth - a.depth) / (b.depth - a.depth);
    }
    return table.back().length;
}

/// The surface as a steady hand takes it.
struct Ground {
    Vec3 normal;
    double height = 0;  ///< metres above the sample, along `normal`
};

std::vector<Ground> level_out(std::span<const LaidSample> samples, double steady) {
    constexpr std::size_t kMost = 64;  // samples looked at to each side
    constexpr double kNear = 0.5;      // radians: normals further off belong to a groove's wall
    std::vector<double> along(samples.size(), 0);
    for (std::size_t i = 1; i < samples.size(); ++i)
        along[i] = along[i - 1] + glm::length(samples[i].position - samples[i - 1].position);

    std::vector<Ground> grounds;
    grounds.reserve(samples.size());
    std::vector<std::size_t> window;
    std::vector<double> heights;
    std::size_t first = 0, last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Ground g{samples[i].normal, 0};
        while (along[i] - along[first] > steady) ++first;
        while (last + 1 < samples.size() && along[last + 1] - along[i] <= steady) ++last;
        // As far to one side as to the other, so that ends do not pull.
        const double reach = std::min(along[i] - along[first], along[last] - along[i]);
        window.clear();
        const std::size_t stride = std::max<std::size_t>(1, (last - first) / (2 * kMost));
        for (std::size_t j = first; j <= last; j += stride)
            if (std::abs(along[j] - along[i]) <= reach) window.push_back(j);
        if (window.size() > 2) {
            Vec3 mean{0};
            for (const std::size_t j : window) mean += samples[j].normal;
            for (int pass = 0; pass < 3 && glm::length(mean) > 0; ++pass) {
                const Vec3 axis = glm::normalize(mean);
                mean = Vec3(0);
                for (const std::size_t j : window) {
                    const double off =
                        std::acos(std::clamp(glm::dot(axis, samples[j].normal), -1.0, 1.0));
                    mean += std::max(0.0, 1 - off * off / (kNear * kNear)) * samples[j].normal;
                }
            }
            if (glm::length(mean) > 0) g.normal = glm::normalize(mean);
            heights.clear();
            for (const std::size_t j : window)
                heights.push_back(glm::dot(samples[j].position - samples[i].position, g.normal));
            std::nth_element(heights.begin(), heights.begin() + std::ptrdiff_t(heights.size() / 2),
                             heights.end());
            g.height = heights[heights.size() / 2];
        }
        grounds.push_back(g);
    }
    return grounds;
}

}  // namespace

Walk walk(const TriangleMesh& mesh, const SurfacePoint& start, const Vec3& direction,
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
    Walk out;
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

LaidTrace lay(const mesh::SurfaceQuery& query, const Trace& trace) {
    check(trace);
    return trace.placement.laying == Laying::wrap ? lay_wrapped(query, trace)
                                                  : lay_projected(query, trace);
}

double working_depth(const brush::Preset& preset) {
    return 0.5 * preset.length;
}

HoldOptions hold_options(const brush::Preset& preset) {
    return {.tuft_length = preset.length,
            .working_depth = working_depth(preset),
            .hover = 0.1 * preset.length,
            .lead = {}};
}

std::vector<Lead> drag_lead(const brush::Preset& preset) {
    std::vector<double> depths;
    for (const double part : {0.05, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
        depths.push_back(part * working_depth(preset));
    std::vector<Lead> lead{{0, 0}};
    for (const brush::SweepRow& row : brush::sweep_depth(preset, depths))
        lead.push_back({row.depth, std::max(0.0, row.offset + 0.5 * row.width)});
    return lead;
}

Trace lead_hand(Trace trace, const HoldOptions& options) {
    if (options.lead.empty() || trace.samples.empty() || !trace.flat) return trace;
    // The hand knows where it is going to start: the string is taut from the first touch.
    const Vec2 first(trace.samples.front().position);
    Vec2 dragged = first;
    for (const TraceSample& s : trace.samples) {
        const Vec2 way = Vec2(s.position) - first;
        if (glm::length(way) >= 0.5 * options.lead_turn) {
            dragged = first - way * (options.lead_turn / glm::length(way));
            break;
        }
    }
    for (TraceSample& s : trace.samples) {
        const Vec2 p(s.position);
        Vec2 string = p - dragged;
        const double length = glm::length(string);
        if (length > options.lead_turn) {
            string *= options.lead_turn / length;
            dragged = p - string;
        }
        const double depth = std::clamp(s.pressure, 0.0, 1.0) * options.working_depth;
        const Vec2 ahead = p + (lead_length(options.lead, depth) / options.lead_turn) * string;
        s.position = Vec3(ahead, s.position.z);
    }
    return trace;
}

std::vector<brush::Pose> hold(std::span<const LaidSample> samples, const HoldOptions& options) {
    std::vector<brush::Pose> poses;
    poses.reserve(samples.size());
    const std::vector<Ground> grounds = level_out(samples, options.steady);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LaidSample& s = samples[i];
        const Ground& ground = grounds[i];
        const Axes axes = axes_across(ground.normal, s.right, s.down);
        const double lean = std::min(glm::length(s.tilt), options.max_tilt);
        const Vec2 tilt = lean > 0 ? s.tilt * (lean / glm::length(s.tilt)) : Vec2{0};
        const Vec3 up = glm::normalize(ground.normal + std::tan(tilt.x) * axes.right +
                                       std::tan(tilt.y) * axes.down);
        const double depth = s.pressure > 0 ? s.pressure * options.working_depth : -options.hover;
        const Vec3 x = into_plane(axes.right, up);
        brush::Pose pose;
        pose.position =
            s.position + (ground.height - depth) * ground.normal + options.tuft_length * up;
        pose.rotation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up)));
        pose.time = s.time;
        poses.push_back(pose);
    }
    return poses;
}

std::vector<brush::Pose> spatial_poses(const Trace& trace) {
    std::vector<brush::Pose> poses;
    poses.reserve(trace.samples.size());
    for (const TraceSample& s : trace.samples)
        poses.push_back({s.position, glm::normalize(s.rotation), s.time});
    return poses;
}

HandPath hand_path(const mesh::SurfaceQuery& query, const Trace& trace,
                   const HoldOptions& options) {
    if (!trace.flat) return {{}, spatial_poses(trace)};
    HandPath path;
    path.laid = lay(query, lead_hand(trace, options));
    path.poses = hold(path.laid.samples, options);
    return path;
}

}  // namespace tuft::stroke
