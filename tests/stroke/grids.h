#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "stroke/placement/placement.h"

/// Surfaces with known straightest lines, and flat points to lay on them.
namespace tuft::stroke {

using mesh::SurfaceQuery;
using mesh::TriangleMesh;
using std::numbers::pi;

/// A grid of (nu + 1) × (nv + 1) vertices put into space by `place`, with normals of
/// `normal`; vertices that coincide are shared, so a grid can close on itself.
inline TriangleMesh make_grid(int nu, int nv, const std::function<Vec3(double, double)>& place,
                              const std::function<Vec3(const Vec3&)>& normal) {
    TriangleMesh m;
    std::map<std::array<long, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> id;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) {
            const Vec3 p = place(double(i) / nu, double(j) / nv);
            const std::array<long, 3> key{std::lround(p.x * 1e8), std::lround(p.y * 1e8), std::lround(p.z * 1e8)};
            const auto [it, fresh] = known.try_emplace(key, std::uint32_t(m.positions.size()));
            if (fresh) m.positions.push_back(Vec3f(p));
            m.bounds.add(p);
            id.push_back(it->second);
        }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == b || b == c || c == a) return;
        m.triangles.push_back({a, b, c});
        for (auto v : {a, b, c}) m.corner_normals.push_back(Vec3f(normal(Vec3(m.positions[v]))));
    };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const auto a = id[j * (nu + 1) + i], b = id[j * (nu + 1) + i + 1];
            const auto c = id[(j + 1) * (nu + 1) + i + 1], d = id[(j + 1) * (nu + 1) + i];
            if ((i + j) % 2)
                add(a, b, c), add(a, c, d);
            else
                add(a, b, d), add(b, c, d);
        }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> owner;
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) owner[{m.triangles[t][k], m.triangles[t][(k + 1) % 3]}] = t;
    for (const auto& t : m.triangles)
        for (int k = 0; k < 3; ++k) {
            const auto it = owner.find({t[(k + 1) % 3], t[k]});
            m.neighbours.push_back(it == owner.end() ? kNone : it->second);
        }
    return m;
}

inline TriangleMesh make_sheet(double side = 0.2, int n = 23) {
    return make_grid(
        n, n, [=](double u, double v) { return Vec3((u - 0.5) * side, (v - 0.5) * side, 0); },
        [](const Vec3&) { return Vec3(0, 0, 1); });
}

inline constexpr double kCylinderRadius = 0.04;
inline TriangleMesh make_cylinder(int around = 180) {
    return make_grid(
        around, 40,
        [](double u, double v) {
            const double a = 2 * pi * u;
            return Vec3(kCylinderRadius * std::cos(a), kCylinderRadius * std::sin(a), 0.12 * (v - 0.5));
        },
        [](const Vec3& p) { return glm::normalize(Vec3(p.x, p.y, 0)); });
}

inline constexpr double kSphereRadius = 0.05;
inline TriangleMesh make_sphere(int n = 96) {
    return make_grid(
        2 * n, n,
        [](double u, double v) {
            const double a = 2 * pi * u, b = pi * (v - 0.5);
            return kSphereRadius * Vec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
        },
        [](const Vec3& p) { return glm::normalize(p); });
}

inline Trace make_trace(const Placement& placement, const std::vector<Vec2>& points) {
    Trace t;
    t.placement = placement;
    for (std::size_t i = 0; i < points.size(); ++i)
        t.samples.push_back({.time = 0.005 * double(i), .position = Vec3(points[i], 0), .pressure = 0.5});
    return t;
}

inline std::vector<Vec2> scattered(std::size_t n, double reach) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < n; ++i)
        out.push_back({reach * (2 * uniform(7, 2 * i) - 1), reach * (2 * uniform(7, 2 * i + 1) - 1)});
    return out;
}

}  // namespace tuft::stroke
