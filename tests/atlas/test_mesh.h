#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "core/random.h"
#include "mesh/triangle_mesh.h"

/// Meshes made on the spot, as clean as `build_surface` leaves them.
namespace tuft::test {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Fills neighbours, normals and bounds. Edges that are not shared by exactly two
/// triangles in opposite directions are borders; triangles without area are dropped.
inline mesh::TriangleMesh finish_mesh(std::vector<Vec3f> positions, const Triangles& triangles) {
    mesh::TriangleMesh m;
    m.positions = std::move(positions);
    for (const auto& t : triangles) {
        const Vec3 a(m.positions[t[0]]), b(m.positions[t[1]]), c(m.positions[t[2]]);
        if (glm::length(glm::cross(b - a, c - a)) > 0) m.triangles.push_back(t);
    }
    const std::size_t n = m.triangles.size();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> edges;
    for (std::size_t t = 0; t < n; ++t)
        for (int k = 0; k < 3; ++k) edges[{m.triangles[t][k], m.triangles[t][(k + 1) % 3]}].push_back(3 * t + k);
    m.neighbours.assign(3 * n, kNone);
    for (const auto& [edge, halves] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (halves.size() == 1 && back != edges.end() && back->second.size() == 1)
            m.neighbours[halves[0]] = static_cast<std::uint32_t>(back->second[0] / 3);
    }
    m.corner_normals.resize(3 * n);
    for (std::size_t t = 0; t < n; ++t) {
        const Vec3 a = m.position(t, 0);
        const Vec3 normal = glm::normalize(glm::cross(m.position(t, 1) - a, m.position(t, 2) - a));
        for (int k = 0; k < 3; ++k) m.corner_normals[3 * t + k] = Vec3f(normal);
    }
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

/// A grid of nu × nv cells mapped by `point`(u, v) with u, v in [0, 1]; `wrap_u`, `wrap_v`
/// glue opposite sides.
inline mesh::TriangleMesh grid_mesh(int nu, int nv, bool wrap_u, bool wrap_v,
                                    const std::function<Vec3(double, double)>& point) {
    const int mu = wrap_u ? nu : nu + 1, mv = wrap_v ? nv : nv + 1;
    std::vector<Vec3f> positions;
    for (int j = 0; j < mv; ++j)
        for (int i = 0; i < mu; ++i) positions.push_back(Vec3f(point(double(i) / nu, double(j) / nv)));
    Triangles triangles;
    const auto at = [&](int i, int j) { return std::uint32_t((j % mv) * mu + i % mu); };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return finish_mesh(std::move(positions), triangles);
}

}  // namespace tuft::test
