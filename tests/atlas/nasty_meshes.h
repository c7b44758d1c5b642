#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "test_mesh.h"

/// Meshes that are clean but ugly: what repaired files look like.
namespace tuft::test {

struct NastyMesh {
    std::string name;
    mesh::TriangleMesh mesh;
};

/// Triangles that share nothing, sizes over four decades.
inline mesh::TriangleMesh loose_triangles(Random& random, int n) {
    std::vector<Vec3f> p;
    Triangles t;
    for (int i = 0; i < n; ++i) {
        const double size = std::pow(10.0, random.uniform(-4, 0));
        const Vec3 centre(random.uniform(), random.uniform(), random.uniform());
        for (int k = 0; k < 3; ++k)
            p.push_back(
                Vec3f(centre + size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
        const auto b = static_cast<std::uint32_t>(3 * i);
        t.push_back({b, b + 1, b + 2});
    }
    return finish_mesh(p, t);
}

/// A sheet whose rows and columns are as narrow as 1e-6 of it: needles and caps.
inline mesh::TriangleMesh slivers(Random& random) {
    std::vector<double> at{0};
    for (int i = 0; i < 24; ++i) at.push_back(at.back() + std::pow(10.0, random.uniform(-6, 0)));
    const double bend = random.uniform(0, 0.5), skew = random.uniform(0, 3);
    return grid_mesh(24, 24, false, false, [&](double u, double v) {
        const double x = at[std::size_t(std::lround(24 * u))], y = at[std::size_t(std::lround(24 * v))];
        return Vec3(x + skew * y, y, bend * x * y);
    });
}

/// A rough height field with triangles torn out: holes, pinched vertices, islands.
inline mesh::TriangleMesh torn_sheet(Random& random, double torn, double rough) {
    const mesh::TriangleMesh whole =
        grid_mesh(30, 30, false, false, [&](double u, double v) { return Vec3(u, v, rough * random.uniform()); });
    Triangles t;
    for (const auto& f : whole.triangles)
        if (random.uniform() > torn) t.push_back(f);
    return finish_mesh(whole.positions, t);
}

/// A ball whose vertices stick out at random.
inline mesh::TriangleMesh spike_ball(Random& random, double spikes) {
    return grid_mesh(32, 16, true, false, [&](double u, double v) {
        const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * (0.02 + 0.96 * v);
        const double r = 1 + spikes * random.uniform();
        return r * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b));
    });
}

/// Fans of many triangles around one vertex, with far less or more than a full turn.
inline mesh::TriangleMesh fans(Random& random) {
    std::vector<Vec3f> p;
    Triangles t;
    for (int fan = 0; fan < 6; ++fan) {
        const int n = 3 + static_cast<int>(random.uniform() * 200);
        const double wave = random.uniform(0, 3), height = random.uniform(0, 4);
        const auto apex = static_cast<std::uint32_t>(p.size());
        p.push_back(Vec3f(5 * fan, 0, float(height)));
        for (int i = 0; i < n; ++i) {
            const double a = 2 * std::numbers::pi * i / n;
            p.push_back(
                Vec3f(float(5 * fan + std::cos(a)), float(std::sin(a)), float(wave * std::sin(a * (i % 2 ? 3 : 5)))));
        }
        for (int i = 0; i < n; ++i)
            t.push_back({apex, apex + 1 + std::uint32_t(i), apex + 1 + std::uint32_t((i + 1) % n)});
    }
    return finish_mesh(p, t);
}

/// The surface of random cubes of a lattice: high genus, creases everywhere.
inline mesh::TriangleMesh voxels(Random& random, double filled) {
    constexpr int n = 6;
    std::vector<bool> full(n * n * n);
    for (std::size_t i = 0; i < full.size(); ++i) full[i] = random.uniform() < filled;
    const auto is_full = [&](int x, int y, int z) {
        return x >= 0 && y >= 0 && z >= 0 && x < n && y < n && z < n && full[(z * n + y) * n + x];
    };
    const auto vertex = [](int x, int y, int z) { return std::uint32_t((z * (n + 1) + y) * (n + 1) + x); };
    std::vector<Vec3f> p;
    for (int z = 0; z <= n; ++z)
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x) p.push_back(Vec3f(x, y, z));
    Triangles t;
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        t.push_back({a, b, c});
        t.push_back({a, c, d});
    };
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                if (!is_full(x, y, z)) continue;
                const auto v = [&](int i, int j, int k) { return vertex(x + i, y + j, z + k); };
                if (!is_full(x - 1, y, z)) quad(v(0, 0, 0), v(0, 0, 1), v(0, 1, 1), v(0, 1, 0));
                if (!is_full(x + 1, y, z)) quad(v(1, 0, 0), v(1, 1, 0), v(1, 1, 1), v(1, 0, 1));
                if (!is_full(x, y - 1, z)) quad(v(0, 0, 0), v(1, 0, 0), v(1, 0, 1), v(0, 0, 1));
                if (!is_full(x, y + 1, z)) quad(v(0, 1, 0), v(0, 1, 1), v(1, 1, 1), v(1, 1, 0));
                if (!is_full(x, y, z - 1)) quad(v(0, 0, 0), v(0, 1, 0), v(1, 1, 0), v(1, 0, 0));
                if (!is_full(x, y, z + 1)) quad(v(0, 0, 1), v(1, 0, 1), v(1, 1, 1), v(0, 1, 1));
            }
    return finish_mesh(p, t);
}

/// Tori from 1 down to 1e-5 of the size, one inside a single large triangle's shadow.
inline mesh::TriangleMesh many_scales(Random& random) {
    std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Triangles t{{0, 1, 2}};
    for (int k = 0; k < 6; ++k) {
        const double size = std::pow(10.0, -k + random.uniform(-0.5, 0));
        const Vec3 centre(random.uniform(), random.uniform(), random.uniform());
        const mesh::TriangleMesh torus = grid_mesh(16, 8, true, true, [&](double u, double v) {
            const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
            const double r = 1 + 0.4 * std::cos(b);
            return centre + size * Vec3(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b));
        });
        const auto base = static_cast<std::uint32_t>(p.size());
        p.insert(p.end(), torus.positions.begin(), torus.positions.end());
        for (const auto& f : torus.triangles) t.push_back({f[0] + base, f[1] + base, f[2] + base});
    }
    return finish_mesh(p, t);
}

/// A sheet refined towards one corner until its triangles are 2^-40 of it.
inline mesh::TriangleMesh graded_sheet(Random& random) {
    const double ratio = random.uniform(0.3, 0.8);
    return grid_mesh(40, 12, false, false, [&](double u, double v) {
        const double r = std::pow(ratio, 40 * u), a = 0.5 * std::numbers::pi * v;
        return Vec3(r * std::cos(a), r * std::sin(a), 0.1 * r * r);
    });
}

/// Fifty-one meshes, the same every time.
inline std::vector<NastyMesh> nasty_meshes() {
    std::vector<NastyMesh> meshes;
    const auto add = [&](std::string name, mesh::TriangleMesh m) {
        if (m.n_triangles() > 0) meshes.push_back({std::move(name), std::move(m)});
    };
    add("one triangle", finish_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    add("needle", finish_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1e-6f, 0}}, {{0, 1, 2}}));
    add("cap", finish_mesh({{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-6f, 0}}, {{0, 1, 2}}));
    add("tiny", finish_mesh({{0, 0, 0}, {1e-9f, 0, 0}, {0, 1e-9f, 0}}, {{0, 1, 2}}));
    add("two sides", finish_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}));
    add("tetrahedron",
        finish_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const std::string tail = " " + std::to_string(seed);
        add("loose triangles" + tail, loose_triangles(random, 40 * int(seed)));
        add("slivers" + tail, slivers(random));
        add("torn sheet" + tail, torn_sheet(random, 0.08 * double(seed), 0));
        add("rough sheet" + tail, torn_sheet(random, 0.1, 0.05 * double(seed)));
        add("spike ball" + tail, spike_ball(random, 0.5 * double(seed)));
        add("fans" + tail, fans(random));
        add("voxels" + tail, voxels(random, 0.12 * double(seed)));
        add("many scales" + tail, many_scales(random));
        add("graded sheet" + tail, graded_sheet(random));
    }
    return meshes;
}

}  // namespace tuft::test
