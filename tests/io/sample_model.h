#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "atlas/atlas.h"
#include "core/random.h"
#include "io/export/export.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/triangle_mesh.h"

/// Models made by formula for the tests of `io`.
namespace tuft::io::testing {

inline constexpr int kAround = 24, kUp = 10;

/// An open cylinder, radius 30 mm, height 50 mm, closed round u with a UV seam.
inline mesh::TriangleMesh cylinder() {
    mesh::TriangleMesh m;
    const auto angle = [](int i) { return 2 * std::numbers::pi * i / kAround; };
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i < kAround; ++i)
            m.positions.emplace_back(0.03 * std::cos(angle(i)), 0.03 * std::sin(angle(i)), 0.05 * j / kUp);
    const auto corner = [&](std::array<std::uint32_t, 3> triangle, std::array<std::array<int, 2>, 3> at) {
        m.triangles.push_back(triangle);
        for (const auto& [i, j] : at) {
            m.corner_normals.emplace_back(std::cos(angle(i)), std::sin(angle(i)), 0);
            m.corner_uvs.emplace_back(0.05 + 0.9 * i / kAround, 0.1 + 0.7 * j / kUp);
        }
    };
    for (int j = 0; j < kUp; ++j)
        for (int i = 0; i < kAround; ++i) {
            const auto v = [&](int a, int b) {
                return static_cast<std::uint32_t>((j + b) * kAround + (i + a) % kAround);
            };
            corner({v(0, 0), v(1, 0), v(1, 1)}, {{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
            corner({v(0, 0), v(1, 1), v(0, 1)}, {{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
        }
    m.neighbours.assign(3 * m.n_triangles(), kNone);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    m.group_names = {"lower", "upper part"};
    for (std::size_t t = 0; t < m.n_triangles(); ++t) m.triangle_groups.push_back(t < m.n_triangles() / 2 ? 0 : 1);
    return m;
}

inline atlas::Atlas cylinder_atlas(const mesh::TriangleMesh& m, std::uint32_t size = 64) {
    atlas::Atlas a;
    a.size = size;
    a.texel_size = 0.19 / size;
    a.corner_uvs = m.corner_uvs;
    a.triangle_chart.assign(m.n_triangles(), 0);
    a.n_charts = 1;
    return a;
}

/// Maps with an asymmetric pattern, so that a flip would show.
inline ModelMaps pattern_maps(std::uint32_t size, bool flat = false) {
    ModelMaps maps;
    maps.base_colour = {.size = size, .channels = 3, .texels = {}};
    maps.orm = {.size = size, .channels = 3, .texels = {}};
    maps.height = {.size = size, .channels = 1, .texels = {}};
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            for (int c = 0; c < 3; ++c)
                maps.base_colour.texels.push_back(static_cast<std::uint8_t>((x * 3 + y * 7 + c * 50) % 256));
            maps.orm.texels.insert(maps.orm.texels.end(), {255, static_cast<std::uint8_t>(y), 0});
            maps.height.texels.push_back(flat ? 0.0f : static_cast<float>(uniform(7, y * size + x) * 3));
        }
    return maps;
}

/// Same triangles in the same order with the same positions and UVs.
inline void expect_same(const mesh::PolygonSoup& soup, const mesh::TriangleMesh& mesh, double metres_per_unit,
                        double uv_error) {
    ASSERT_EQ(soup.n_polygons(), mesh.n_triangles());
    ASSERT_EQ(soup.corner_uvs.size(), 3 * mesh.n_triangles());
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        ASSERT_EQ(soup.polygon_start[t + 1] - soup.polygon_start[t], 3u);
        for (int k = 0; k < 3; ++k) {
            const std::size_t corner = soup.polygon_start[t] + k;
            const Vec3 p = soup.points[soup.corners[corner]] * metres_per_unit;
            EXPECT_EQ(Vec3f(p), mesh.positions[mesh.triangles[t][k]]) << t;
            EXPECT_NEAR(soup.corner_uvs[corner].x, mesh.corner_uvs[3 * t + k].x, uv_error);
            EXPECT_NEAR(soup.corner_uvs[corner].y, mesh.corner_uvs[3 * t + k].y, uv_error);
        }
    }
}

/// A folder for one test, removed with it.
class Folder {
  public:
    explicit Folder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("tuft_io_" + name + "_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ec;
        std::filesystem::remove_all(path_, ec);
    }
    std::filesystem::path operator/(const std::string& file) const { return path_ / file; }
    const std::filesystem::path& path() const { return path_; }
    std::size_t n_files() const {
        std::size_t n = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++n;
        return n;
    }

  private:
    std::filesystem::path path_;
};

}  // namespace tuft::io::testing
