#include "contact/near_vertices.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

namespace tuft::contact {
namespace {

double distance_to_triangle2(const mesh::TriangleMesh& mesh, std::uint32_t t, const Vec3& p) {
    // Smallest squared distance to the foot on the plane, if inside, or to an edge.
    const Vec3 corner[3] = {mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2)};
    const Vec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    double best = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        const Vec3 e = corner[(k + 1) % 3] - corner[k], d = p - corner[k];
        const double u = std::clamp(glm::dot(d, e) / glm::dot(e, e), 0.0, 1.0);
        const Vec3 off = d - u * e;
        best = std::min(best, glm::dot(off, off));
        inside = inside && glm::dot(glm::cross(e, d), n) >= 0;
    }
    if (!inside) return best;
    const double height = glm::dot(p - corner[0], n);
    return height * height / glm::dot(n, n);
}

}  // namespace

WeightedDistance weighted_distance(std::span<const mesh::NearVertex> vertices, const Vec3& tip) {
    WeightedDistance out;
    out.vertices.assign(vertices.begin(), vertices.end());
    double d_max = 0;
    for (const mesh::NearVertex& v : vertices) d_max = std::max(d_max, glm::length(tip - v.position));
    double sum = 0, weights = 0;
    Vec3 normal{0};
    for (const mesh::NearVertex& v : vertices) {
        const double w = d_max > 0 ? 1 - glm::length(tip - v.position) / d_max : 1;
        sum += w * glm::dot(v.normal, tip - v.position);
        normal += w * v.normal;
        weights += w;
    }
    const double length = glm::length(normal);
    out.found = weights > 0 && length > 1e-6 * weights;
    if (!out.found) return out;
    out.distance = sum / weights;
    out.normal = normal / length;
    return out;
}

WeightedDistance weighted_distance(const mesh::SurfaceQuery& surface, const Vec3& tip, const Vec3& holder, int k) {
    // The far side of a wall may be nearer: take more, keep those that face the holder.
    std::vector<mesh::NearVertex> vertices;
    for (int asked = 2 * k; asked <= 64 * k; asked *= 4) {
        vertices = surface.nearest_vertices(tip, asked);
        const bool all = vertices.size() < static_cast<std::size_t>(asked);
        std::erase_if(vertices,
                      [&](const mesh::NearVertex& v) { return glm::dot(v.normal, holder - v.position) <= 0; });
        if (all || vertices.size() >= static_cast<std::size_t>(k)) break;
    }
    if (vertices.size() > static_cast<std::size_t>(k)) vertices.resize(static_cast<std::size_t>(k));
    return weighted_distance(vertices, tip);
}

Vec3 snap_tip(const Vec3& tip, const WeightedDistance& d) {
    return tip - d.distance * d.normal;
}

std::vector<Vec3> outline_points(const brush::TuftState& tuft, int per_section) {
    std::vector<Vec3> points;
    for (const brush::Branch& branch : tuft.branches) {
        if (branch.sections.empty()) continue;
        points.push_back(branch.sections.front().centre);
        for (const brush::Section& s : branch.sections)
            for (int k = 0; k < per_section; ++k) {
                const double omega = 2 * std::numbers::pi * k / per_section;
                points.push_back(s.centre + s.a * std::cos(omega) * s.e + s.b * std::sin(omega) * s.m);
            }
    }
    return points;
}

EffectivePatch effective_patch(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Sphere& sphere,
                               const Vec3& holder) {
    EffectivePatch patch;
    if (triangle >= mesh.n_triangles()) return patch;
    const double r2 = sphere.radius * sphere.radius;
    std::vector<std::uint32_t> walk{triangle};
    std::unordered_set<std::uint32_t> seen{triangle};
    std::unordered_map<std::uint32_t, std::size_t> place;
    double side = 1;
    std::vector<Vec3> sums;  // Σ of the triangles' vector areas / 3, per vertex
    for (std::size_t i = 0; i < walk.size(); ++i) {
        const std::uint32_t t = walk[i];
        const Vec3 a = mesh.position(t, 0);
        Vec3 area = 0.5 * glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a);
        // An open sheet may be met from its back.
        if (i == 0 && glm::dot(area, holder - a) < 0) side = -1;
        area *= side;
        if (i == 0 && glm::length(area) > 0) patch.normal = glm::normalize(area);
        if (i > 0 && (glm::dot(area, holder - a) <= 0 || distance_to_triangle2(mesh, t, sphere.centre) > r2)) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.triangles[t][k];
            const Vec3 d = mesh.position(t, k) - sphere.centre;
            if (glm::dot(d, d) <= r2) {
                const auto [at, fresh] = place.try_emplace(v, patch.vertices.size());
                if (fresh) {
                    patch.vertices.push_back(v);
                    sums.emplace_back(0);
                }
                sums[at->second] += area / 3.0;
                patch.area += glm::length(area) / 3;
            }
            const std::uint32_t next = mesh.neighbours[3 * std::size_t{t} + k];
            if (next != kNone && seen.insert(next).second) walk.push_back(next);
        }
    }
    Vec3 normal{0};
    for (const Vec3& s : sums) normal += s;
    if (glm::length(normal) > 0) patch.normal = glm::normalize(normal);
    return patch;
}

}  // namespace tuft::contact
