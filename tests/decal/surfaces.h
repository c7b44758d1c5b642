#pragma once

#include <cmath>
#include <numbers>
#include <numeric>

#include "../atlas/test_mesh.h"
#include "atlas/seams/chart_mesh.h"
#include "decal/panels/film_mesh.h"

/// Surfaces with known developments.
namespace tuft::test {

inline constexpr double kPi = std::numbers::pi;

/// Part of a cylinder about z of `radius`, from −angle/2 to angle/2 about the x axis, `height` high.
inline mesh::TriangleMesh cylinder_part(double radius, double angle, double height, int around, int up) {
    return grid_mesh(around, up, false, false, [=](double u, double v) {
        const double a = angle * (u - 0.5);
        return Vec3(radius * std::cos(a), radius * std::sin(a), height * v);
    });
}

/// A whole cylinder.
inline mesh::TriangleMesh whole_cylinder(double radius, double height, int around, int up) {
    return grid_mesh(around, up, true, false, [=](double u, double v) {
        return Vec3(radius * std::cos(2 * kPi * u), radius * std::sin(2 * kPi * u), height * v);
    });
}

/// Part of a cone about z with half angle `half`, slant distances `from` to `to` from the apex.
inline mesh::TriangleMesh cone_part(double half, double angle, double from, double to, int around, int up) {
    return grid_mesh(around, up, false, false, [=](double u, double v) {
        const double a = angle * (u - 0.5), s = from + (to - from) * v;
        return Vec3(s * std::sin(half) * std::cos(a), s * std::sin(half) * std::sin(a), s * std::cos(half));
    });
}

/// A cap of a sphere round +z: `rings` rings of 6 k points round the pole.
inline mesh::TriangleMesh sphere_cap(double radius, double polar, int rings) {
    std::vector<Vec3f> positions{Vec3f(0, 0, radius)};
    std::vector<std::uint32_t> start{0};
    for (int k = 1; k <= rings; ++k) {
        start.push_back(static_cast<std::uint32_t>(positions.size()));
        for (int i = 0; i < 6 * k; ++i) {
            const double a = 2 * kPi * i / (6 * k), p = polar * k / rings;
            positions.push_back(Vec3f(
                Vec3(radius * std::sin(p) * std::cos(a), radius * std::sin(p) * std::sin(a), radius * std::cos(p))));
        }
    }
    Triangles triangles;
    const auto at = [&](int k, int i) {
        return k == 0 ? 0u : start[static_cast<std::size_t>(k)] + static_cast<std::uint32_t>(i % (6 * k));
    };
    for (int k = 1; k <= rings; ++k)
        for (int side = 0; side < 6; ++side)
            for (int i = 0; i < k; ++i) {
                const int outer = side * k + i, inner = side * (k - 1) + i;
                triangles.push_back({at(k, outer), at(k, outer + 1), at(k - 1, inner)});
                if (i + 1 < k) triangles.push_back({at(k - 1, inner), at(k, outer + 1), at(k - 1, inner + 1)});
            }
    return finish_mesh(std::move(positions), triangles);
}

/// All of a mesh that is a disk.
inline atlas::ChartMesh chart_of(const mesh::TriangleMesh& m) {
    std::vector<std::uint32_t> all(m.n_triangles());
    std::iota(all.begin(), all.end(), 0u);
    return atlas::make_chart(m, atlas::twin_half_edges(m), all, 1.0);
}

/// Where the chart has its vertex at a corner of a triangle of the mesh.
inline std::uint32_t vertex_at(const atlas::ChartMesh& chart, std::uint32_t triangle, int corner) {
    const auto it = std::lower_bound(chart.triangles.begin(), chart.triangles.end(), triangle);
    return chart.faces[static_cast<std::size_t>(it - chart.triangles.begin())][static_cast<std::size_t>(corner)];
}

/// Coverage 1 where `painted` of the point holds.
template <class Painted>
decal::CoverageFn coverage_where(const mesh::TriangleMesh& model, Painted painted) {
    return [&model, painted](std::uint32_t triangle, const decal::Weights& w) {
        return painted(decal::point_at(model, triangle, w)) ? 1.0 : 0.0;
    };
}

/// Millimetres.
inline constexpr double kMm = 1e-3;

}  // namespace tuft::test
