#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/read/polygon_soup.h"
#include "mesh/repair/repair.h"

/// Small meshes and the laws every repaired surface obeys, for the tests of this module.
namespace tuft::mesh {

inline std::vector<char> bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

/// Appends a polygon over existing points.
inline void add_polygon(PolygonSoup& soup, const std::vector<std::uint32_t>& corners) {
    if (soup.polygon_start.empty()) soup.polygon_start.push_back(0);
    soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
}

/// A box from `lo` to `lo + size`, six quads, normals outward. Point k has x from bit 0, y from
/// bit 1, z from bit 2 of k.
inline void add_box(PolygonSoup& soup, const Vec3& lo, const Vec3& size) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (int k = 0; k < 8; ++k) soup.points.push_back(lo + size * Vec3(k & 1, k >> 1 & 1, k >> 2 & 1));
    constexpr std::uint32_t kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : kQuads) add_polygon(soup, {first + q[0], first + q[1], first + q[2], first + q[3]});
}

inline PolygonSoup make_box(const Vec3& lo = Vec3(0), const Vec3& size = Vec3(1)) {
    PolygonSoup soup;
    add_box(soup, lo, size);
    return soup;
}

/// n x n squares of two triangles in the plane z = 0, from (0, 0) to (n, n).
inline PolygonSoup make_sheet(std::uint32_t n) {
    PolygonSoup soup;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) soup.points.emplace_back(i, j, 0);
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            add_polygon(soup, {a, b, c});
            add_polygon(soup, {a, c, d});
        }
    return soup;
}

/// Torus of nu x nv squares of two triangles, radii 30 and 10, normals outward.
inline PolygonSoup make_torus(std::uint32_t nu, std::uint32_t nv) {
    PolygonSoup soup;
    for (std::uint32_t i = 0; i < nu; ++i)
        for (std::uint32_t j = 0; j < nv; ++j) {
            const double u = 6.283185307179586 * i / nu, v = 6.283185307179586 * j / nv;
            const double r = 30 + 10 * std::cos(v);
            soup.points.emplace_back(r * std::cos(u), r * std::sin(u), 10 * std::sin(v));
        }
    const auto id = [&](std::uint32_t i, std::uint32_t j) { return i % nu * nv + j % nv; };
    for (std::uint32_t i = 0; i < nu; ++i)
        for (std::uint32_t j = 0; j < nv; ++j) {
            add_polygon(soup, {id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            add_polygon(soup, {id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return soup;
}

/// Texture coordinates that equal x and y of each corner, so that a corner that loses its own
/// is found out.
inline void set_uvs_to_position(PolygonSoup& soup) {
    soup.corner_uvs.clear();
    for (const std::uint32_t c : soup.corners) soup.corner_uvs.emplace_back(soup.points[c].x, soup.points[c].y);
}

inline double signed_volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        sum += glm::dot(mesh.position(t, 0), glm::cross(mesh.position(t, 1), mesh.position(t, 2)));
    return sum / 6;
}

/// Every broken promise of `TriangleMesh` and of the report, in words; empty when all hold.
/// Works from the arrays alone, by brute force.
inline std::vector<std::string> broken_promises(const Surface& surface) {
    const TriangleMesh& m = surface.mesh;
    std::vector<std::string> broken;
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds && broken.size() < 10) broken.push_back(what);
    };
    const std::size_t n = m.n_triangles();
    require(n > 0, "no triangle");
    require(m.corner_normals.size() == 3 * n && m.neighbours.size() == 3 * n, "array sizes");
    require(m.corner_uvs.empty() || m.corner_uvs.size() == 3 * n, "uv size");
    require(m.triangle_groups.empty() || m.triangle_groups.size() == n, "group size");
    require(m.vertex_colours.empty() || m.vertex_colours.size() == m.n_vertices(), "colour size");
    if (!broken.empty()) return broken;

    std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> half_edges;  // directed
    std::set<std::array<std::uint32_t, 3>> seen;
    std::vector<std::vector<std::uint32_t>> corners_at(m.n_vertices());
    Box bounds;
    for (std::uint32_t t = 0; t < n; ++t) {
        std::array<std::uint32_t, 3> v = m.triangles[t];
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (v[k] >= m.n_vertices()) return {"index out of range"};
            half_edges[{v[k], v[(k + 1) % 3]}].push_back(3 * t + k);
            corners_at[v[k]].push_back(3 * t + k);
            bounds.add(m.position(t, static_cast<int>(k)));
            const Vec3f normal = m.corner_normals[3 * t + k];
            require(std::abs(glm::length(normal) - 1) < 1e-5, "normal is not of unit length");
        }
        const Vec3 area = glm::cross(m.position(t, 1) - m.position(t, 0), m.position(t, 2) - m.position(t, 0));
        require(glm::length(area) > 0, "triangle " + std::to_string(t) + " has no area");
        std::sort(v.begin(), v.end());
        require(v[0] != v[1] && v[1] != v[2], "repeated corner");
        require(seen.insert(v).second, "duplicate triangle");
    }
    require(bounds.lo == m.bounds.lo && bounds.hi == m.bounds.hi, "bounds");

    std::size_t border = 0;
    for (const auto& [edge, list] : half_edges) {
        require(list.size() == 1, "two triangles run the same way along an edge");
        const auto back = half_edges.find({edge[1], edge[0]});
        const std::uint32_t over = back == half_edges.end() ? kNone : back->second[0] / 3;
        if (over == kNone) ++border;
        require(m.neighbours[list[0]] == over, "neighbours do not say what the indices say");
    }
    // One fan per vertex: walking over neighbours from any corner reaches all the others.
    for (std::uint32_t v = 0; v < m.n_vertices(); ++v) {
        require(!corners_at[v].empty(), "unused vertex");
        if (corners_at[v].empty() || !broken.empty()) continue;
        std::set<std::uint32_t> reached;
        std::vector<std::uint32_t> stack{corners_at[v][0] / 3};
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            if (!reached.insert(t).second) continue;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t over = m.neighbours[3 * t + k];
                const bool at_v = m.triangles[t][k] == v || m.triangles[t][(k + 1) % 3] == v;
                if (over != kNone && at_v) stack.push_back(over);
            }
        }
        require(reached.size() == corners_at[v].size(), "a vertex has several fans");
    }
    std::vector<bool> reached(n, false);
    std::size_t components = 0;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
        if (reached[seed]) continue;
        ++components;
        std::vector<std::uint32_t> stack{seed};
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            if (reached[t]) continue;
            reached[t] = true;
            for (std::size_t k = 0; k < 3; ++k)
                if (m.neighbours[3 * t + k] != kNone) stack.push_back(m.neighbours[3 * t + k]);
        }
    }
    require(surface.report.components == components, "components in the report");
    require(surface.report.border_edges == border, "border edges in the report");
    require(surface.report.closed == (border == 0), "closed in the report");
    require((surface.report.holes == 0) == (border == 0), "holes in the report");
    return broken;
}

}  // namespace tuft::mesh
