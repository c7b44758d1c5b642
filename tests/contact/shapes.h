#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "mesh/triangle_mesh.h"

/// Meshes made by formula for the contact tests, metres.
namespace tuft::shapes {

/// Corner normals split at 40°, neighbours and bounds.
inline void finish(mesh::TriangleMesh& m) {
    std::vector<std::vector<std::uint32_t>> round(m.n_vertices());
    std::vector<Vec3> area(m.n_triangles());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edge;
    for (std::uint32_t t = 0; t < m.n_triangles(); ++t) {
        area[t] = glm::cross(m.position(t, 1) - m.position(t, 0), m.position(t, 2) - m.position(t, 0));
        for (int k = 0; k < 3; ++k) {
            round[m.triangles[t][k]].push_back(t);
            edge[{m.triangles[t][k], m.triangles[t][(k + 1) % 3]}] = t;
        }
    }
    for (std::uint32_t t = 0; t < m.n_triangles(); ++t)
        for (int k = 0; k < 3; ++k) {
            Vec3 n{0};
            for (const std::uint32_t other : round[m.triangles[t][k]])
                if (glm::dot(glm::normalize(area[other]), glm::normalize(area[t])) > 0.766) n += area[other];
            m.corner_normals.emplace_back(glm::normalize(n));
            const auto over = edge.find({m.triangles[t][(k + 1) % 3], m.triangles[t][k]});
            m.neighbours.push_back(over == edge.end() ? kNone : over->second);
        }
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
}

/// n × n quads over (u, v) in [0, 1]², seen from where u × v points.
inline mesh::TriangleMesh surface(int nu, int nv, const std::function<Vec3(double, double)>& at) {
    mesh::TriangleMesh m;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) m.positions.emplace_back(at(double(i) / nu, double(j) / nv));
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const std::uint32_t a = j * (nu + 1) + i, b = a + 1, c = a + nu + 1, d = c + 1;
            m.triangles.push_back({a, b, d});
            m.triangles.push_back({a, d, c});
        }
    finish(m);
    return m;
}

/// Flat sheet in z = 0 of the given side, centred.
inline mesh::TriangleMesh sheet(double side = 0.2, int n = 100) {
    return surface(n, n, [=](double u, double v) { return Vec3{side * (u - 0.5), side * (v - 0.5), 0}; });
}

/// Half a sphere of radius r about the origin, seen from inside (a bowl open to +z).
inline mesh::TriangleMesh bowl(double r, int n = 120) {
    return surface(2 * n, n, [=](double u, double v) {
        const double phi = -2 * std::numbers::pi * u, theta = (1 - 0.5 * v) * std::numbers::pi;
        const double s = v == 0 ? 1e-6 : std::sin(theta);
        return Vec3{r * s * std::cos(phi), r * s * std::sin(phi), r * std::cos(theta)};
    });
}

/// Roof (or gutter) of two planes that meet along the y axis at z = 0, each sloping by `angle`
/// (positive: a convex edge).
inline mesh::TriangleMesh roof(double angle, double side = 0.2, int n = 100) {
    return surface(n, n, [=](double u, double v) {
        const double x = side * (u - 0.5);
        return Vec3{x * std::cos(angle), side * (v - 0.5), -std::abs(x) * std::sin(angle)};
    });
}

/// Closed box.
inline mesh::TriangleMesh plate(const Vec3& half, int n = 40) {
    mesh::TriangleMesh all;
    std::map<std::array<float, 3>, std::uint32_t> index;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            const auto face = [&](double u, double v) {
                Vec3 p{0};
                p[axis] = sign * half[axis];
                p[(axis + 1) % 3] = half[(axis + 1) % 3] * (2 * u - 1) * sign;
                p[(axis + 2) % 3] = half[(axis + 2) % 3] * (2 * v - 1);
                return p;
            };
            const int nu = half[(axis + 1) % 3] < 0.01 ? 1 : n, nv = half[(axis + 2) % 3] < 0.01 ? 1 : n;
            const mesh::TriangleMesh part = surface(nu, nv, face);
            for (const auto& t : part.triangles) {
                std::array<std::uint32_t, 3> out{};
                for (int k = 0; k < 3; ++k) {
                    const Vec3f p = part.positions[t[k]];
                    const auto [at, fresh] = index.try_emplace({p.x, p.y, p.z}, all.positions.size());
                    if (fresh) all.positions.push_back(p);
                    out[k] = at->second;
                }
                all.triangles.push_back(out);
            }
        }
    finish(all);
    return all;
}

/// The mesh turned by q and moved by d.
inline mesh::TriangleMesh moved(const mesh::TriangleMesh& in, const Quat& q, const Vec3& d) {
    mesh::TriangleMesh out;
    out.triangles = in.triangles;
    for (const Vec3f& p : in.positions) out.positions.emplace_back(q * Vec3(p) + d);
    finish(out);
    return out;
}

}  // namespace tuft::shapes
