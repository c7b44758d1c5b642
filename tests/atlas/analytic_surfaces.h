#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "atlas/atlas.h"

/// Surfaces with known geometry, unwrapped by formula: what maps from texels to the
/// surface and stamps on it are measured against.
namespace tuft::testing {

/// One chart: a grid over (s, t) in [0, 1]², placed in the atlas at
/// uv0 + s uv_s + t uv_t (texels).
struct Patch {
    std::function<Vec3(double s, double t)> position;
    std::function<Vec3(double s, double t)> normal;
    int ns = 8, nt = 8;
    Vec2 uv0{8}, uv_s{100, 0}, uv_t{0, 100};
};

struct Unwrapped {
    mesh::TriangleMesh mesh;
    atlas::Atlas atlas;
};

inline Unwrapped build(const std::vector<Patch>& patches, std::uint32_t size) {
    Unwrapped u;
    u.atlas.size = size;
    u.atlas.n_charts = static_cast<std::uint32_t>(patches.size());
    std::map<std::array<long long, 3>, std::uint32_t> welded;
    const auto vertex = [&](const Vec3& p) {
        const std::array<long long, 3> key{std::llround(p.x * 1e8), std::llround(p.y * 1e8), std::llround(p.z * 1e8)};
        const auto [it, fresh] = welded.try_emplace(key, static_cast<std::uint32_t>(u.mesh.positions.size()));
        if (fresh) {
            u.mesh.positions.emplace_back(p);
            u.mesh.bounds.add(p);
        }
        return it->second;
    };
    for (std::uint32_t chart = 0; chart < patches.size(); ++chart) {
        const Patch& patch = patches[chart];
        for (int j = 0; j < patch.nt; ++j) {
            for (int i = 0; i < patch.ns; ++i) {
                const std::array<Vec2, 4> st{Vec2(i, j), Vec2(i + 1, j), Vec2(i + 1, j + 1), Vec2(i, j + 1)};
                for (const std::array<int, 3>& t : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
                    std::array<std::uint32_t, 3> corners;
                    for (int k = 0; k < 3; ++k) {
                        const Vec2 q = st[t[k]] / Vec2(patch.ns, patch.nt);
                        corners[k] = vertex(patch.position(q.x, q.y));
                        u.mesh.corner_normals.emplace_back(patch.normal(q.x, q.y));
                        u.atlas.corner_uvs.emplace_back((patch.uv0 + q.x * patch.uv_s + q.y * patch.uv_t) /
                                                        double(size));
                    }
                    u.mesh.triangles.push_back(corners);
                    u.atlas.triangle_chart.push_back(chart);
                }
            }
        }
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
    for (std::uint32_t t = 0; t < u.mesh.n_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) edges[{u.mesh.triangles[t][k], u.mesh.triangles[t][(k + 1) % 3]}] = t;
    }
    u.mesh.neighbours.assign(3 * u.mesh.n_triangles(), kNone);
    for (std::uint32_t t = 0; t < u.mesh.n_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const auto it = edges.find({u.mesh.triangles[t][(k + 1) % 3], u.mesh.triangles[t][k]});
            if (it != edges.end()) u.mesh.neighbours[3 * t + k] = it->second;
        }
    }
    return u;
}

/// Flat parallelogram from `origin` along `s` and `t`.
inline Patch flat(const Vec3& origin, const Vec3& s, const Vec3& t, int ns, int nt) {
    const Vec3 n = glm::normalize(glm::cross(s, t));
    Patch p;
    p.position = [=](double a, double b) { return origin + a * s + b * t; };
    p.normal = [=](double, double) { return n; };
    p.ns = ns;
    p.nt = nt;
    return p;
}

inline Patch& place(Patch& p, Vec2 uv0, Vec2 uv_s, Vec2 uv_t) {
    p.uv0 = uv0;
    p.uv_s = uv_s;
    p.uv_t = uv_t;
    return p;
}

/// Square sheet z = 0 of `side` metres about the origin in n × n charts of `texels` texels
/// a side, each turned by another quarter in the atlas, 8 texels apart.
inline Unwrapped sheet(double side, int n, double texels, int grid = 8) {
    std::vector<Patch> patches;
    const double step = texels + 8.37;  // charts lie at odd fractions of a texel
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double w = side / n;
            Patch p = flat({-0.5 * side + i * w, -0.5 * side + j * w, 0}, {w, 0, 0}, {0, w, 0}, grid, grid);
            const Vec2 at{8.21 + step * i, 8.13 + step * j};
            switch ((i + 2 * j) % 4) {
                case 0:
                    place(p, at, {texels, 0}, {0, texels});
                    break;
                case 1:
                    place(p, at + Vec2{texels, 0}, {0, texels}, {-texels, 0});
                    break;
                case 2:
                    place(p, at + Vec2{texels, texels}, {-texels, 0}, {0, -texels});
                    break;
                default:
                    place(p, at + Vec2{0, texels}, {0, -texels}, {texels, 0});
                    break;
            }
            patches.push_back(p);
        }
    }
    return build(patches, static_cast<std::uint32_t>(step * n + 20));
}

/// Cylinder round z of radius r, height h, in `n` strips.
inline Unwrapped cylinder(double r, double h, int n, double texels_per_metre, int grid = 64) {
    std::vector<Patch> patches;
    const double width = 2 * std::numbers::pi * r / n * texels_per_metre, height = h * texels_per_metre;
    for (int k = 0; k < n; ++k) {
        const double a0 = 2 * std::numbers::pi * k / n, da = 2 * std::numbers::pi / n;
        Patch p;
        p.position = [=](double s, double t) {
            const double a = k == n - 1 && s == 1 ? 0 : a0 + s * da;
            return Vec3{r * std::cos(a), r * std::sin(a), (t - 0.5) * h};
        };
        p.normal = [=](double s, double) { return Vec3{std::cos(a0 + s * da), std::sin(a0 + s * da), 0}; };
        p.ns = grid;
        p.nt = 4;
        place(p, {8.3 + k * (width + 9), 8.4}, {width, 0}, {0, height});
        patches.push_back(p);
    }
    return build(patches, static_cast<std::uint32_t>(std::max(n * (width + 9), height) + 20));
}

/// Sphere of radius r about the origin from six charts (cube faces with even angles).
inline Unwrapped sphere(double r, double texels, int grid = 48) {
    static const std::array<std::array<Vec3, 3>, 6> faces{{{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                           {Vec3{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
                                                           {Vec3{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                                           {Vec3{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                           {Vec3{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                                                           {Vec3{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}};
    std::vector<Patch> patches;
    for (int f = 0; f < 6; ++f) {
        Patch p;
        const auto direction = [f](double s, double t) {
            const double x = std::tan((s - 0.5) * 0.5 * std::numbers::pi);
            const double y = std::tan((t - 0.5) * 0.5 * std::numbers::pi);
            return glm::normalize(faces[f][0] + x * faces[f][1] + y * faces[f][2]);
        };
        p.position = [=](double s, double t) { return r * direction(s, t); };
        p.normal = direction;
        p.ns = p.nt = grid;
        place(p, {8.2 + (f % 3) * (texels + 9.3), 8.2 + (f / 3) * (texels + 9.3)}, {texels, 0}, {0, texels});
        patches.push_back(p);
    }
    return build(patches, static_cast<std::uint32_t>(3 * (texels + 9.3) + 20));
}

/// Plate of side `a` and thickness `d`, top at z = 0, all six faces charts of their own.
inline Unwrapped plate(double a, double d, double texels, int grid = 16) {
    const double h = 0.5 * a, band = texels * d / a;
    const double x1 = 8.3, x2 = x1 + texels + 9, y1 = 8.4;
    std::vector<Patch> patches;
    Patch top = flat({-h, -h, 0}, {a, 0, 0}, {0, a, 0}, grid, grid);
    patches.push_back(place(top, {x1, y1}, {texels, 0}, {0, texels}));
    Patch bottom = flat({-h, h, -d}, {a, 0, 0}, {0, -a, 0}, grid, grid);
    patches.push_back(place(bottom, {x2, y1}, {texels, 0}, {0, texels}));
    const std::array<std::array<Vec3, 2>, 4> rims{{{Vec3{-h, -h, -d}, {a, 0, 0}},
                                                   {Vec3{h, -h, -d}, {0, a, 0}},
                                                   {Vec3{h, h, -d}, {-a, 0, 0}},
                                                   {Vec3{-h, h, -d}, {0, -a, 0}}}};
    for (int k = 0; k < 4; ++k) {
        Patch rim = flat(rims[k][0], rims[k][1], {0, 0, d}, grid, 1);
        patches.push_back(place(rim, {x1, y1 + texels + 9 + k * (band + 9)}, {texels, 0}, {0, band}));
    }
    return build(patches, static_cast<std::uint32_t>(x2 + texels + 4 * (band + 9) + 20));
}

/// Two square leaves of side `a` that meet at a right angle along y at x = 0: z = 0 for
/// x < 0 and x = 0 going down for z < 0. One chart or two.
inline Unwrapped right_angle(double a, double texels, bool one_chart, int grid = 8) {
    Patch level = flat({-a, -0.5 * a, 0}, {a, 0, 0}, {0, a, 0}, grid, grid);
    Patch down = flat({0, -0.5 * a, 0}, {0, 0, -a}, {0, a, 0}, grid, grid);
    const double gap = one_chart ? 0 : 9;
    place(level, {8.37, 8.4}, {texels, 0}, {0, texels});
    place(down, {8.37 + texels + gap, 8.4}, {texels, 0}, {0, texels});
    Unwrapped u = build({level, down}, static_cast<std::uint32_t>(2 * texels + 40));
    if (one_chart) {
        std::fill(u.atlas.triangle_chart.begin(), u.atlas.triangle_chart.end(), 0);
        u.atlas.n_charts = 1;
    }
    return u;
}

}  // namespace tuft::testing
