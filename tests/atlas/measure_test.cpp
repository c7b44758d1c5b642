#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "atlas/atlas.h"
#include "atlas/pack/coverage.h"
#include "core/random.h"
#include "test_mesh.h"

// Hand-made atlases whose figures can be worked out on paper. Stretch is that of Sander et
// al. 2001 after the UVs are scaled to the surface's area.
namespace tuft::atlas {
namespace {

using Quad = std::array<std::uint32_t, 4>;

mesh::TriangleMesh quads(const std::vector<Vec3f>& positions, const std::vector<Quad>& faces) {
    test::Triangles triangles;
    for (const Quad& q : faces) {
        triangles.push_back({q[0], q[1], q[2]});
        triangles.push_back({q[0], q[2], q[3]});
    }
    return test::finish_mesh(positions, triangles);
}

/// One rectangle of UVs (x0, y0)–(x1, y1) per quad, each a chart.
Atlas rectangles(const std::vector<std::array<float, 4>>& uv, std::uint32_t size) {
    Atlas atlas;
    atlas.size = size;
    atlas.n_charts = static_cast<std::uint32_t>(uv.size());
    for (std::uint32_t c = 0; c < uv.size(); ++c) {
        const auto [x0, y0, x1, y1] = uv[c];
        const Vec2f p[4] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
        for (const int k : {0, 1, 2, 0, 2, 3}) atlas.corner_uvs.push_back(p[k]);
        atlas.triangle_chart.insert(atlas.triangle_chart.end(), 2, c);
    }
    return atlas;
}

const std::vector<Vec3f> kTwoSquares{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};

TEST(Measure, CubeOfSixSquares) {
    std::vector<Vec3f> p;
    for (int i = 0; i < 8; ++i) p.push_back(Vec3f(i >> 2 & 1, i >> 1 & 1, i & 1));
    const mesh::TriangleMesh cube =
        quads(p, {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}});
    std::vector<std::array<float, 4>> uv;
    for (int i = 0; i < 6; ++i) {
        const float x = 0.0625f + 0.3125f * float(i % 3), y = 0.0625f + 0.3125f * float(i / 3);
        uv.push_back({x, y, x + 0.25f, y + 0.25f});
    }
    const AtlasReport r = measure(cube, rectangles(uv, 1024));
    EXPECT_EQ(r.charts, 6u);
    EXPECT_NEAR(r.seam_length, 12 / std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(r.l2_stretch, 1, 1e-9);
    EXPECT_NEAR(r.linf_stretch, 1, 1e-9);
    EXPECT_NEAR(r.angle_distortion, 1, 1e-9);
    EXPECT_NEAR(r.area_distortion, 1, 1e-9);
    EXPECT_DOUBLE_EQ(r.utilisation, 6 * 256.0 * 256 / 1024 / 1024);
    EXPECT_EQ(r.smallest_gap, 64);
    EXPECT_EQ(r.flips + r.overlapping_texels + r.zero_area_triangles, 0u);
}

TEST(Measure, SquareSquashedToHalfItsHeight) {
    const mesh::TriangleMesh square = quads({kTwoSquares.begin(), kTwoSquares.begin() + 4}, {{0, 1, 2, 3}});
    const AtlasReport r = measure(square, rectangles({{0, 0, 1, 0.5f}}, 64));
    // Singular values of the map UV -> surface: 1/√2 and √2.
    EXPECT_NEAR(r.l2_stretch, std::sqrt(1.25), 1e-9);
    EXPECT_NEAR(r.linf_stretch, std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(r.angle_distortion, 2, 1e-9);
    EXPECT_NEAR(r.area_distortion, 1, 1e-9);
    EXPECT_EQ(r.smallest_gap, 64);  // there is no other chart
}

TEST(Measure, ChartsOfDifferentScale) {
    const mesh::TriangleMesh two = quads(kTwoSquares, {{0, 1, 2, 3}, {4, 5, 6, 7}});
    const AtlasReport r = measure(two, rectangles({{0, 0, 0.5f, 0.5f}, {0.6f, 0.6f, 0.85f, 0.85f}}, 64));
    // Areas 1/4 and 1/16 for 1 and 1: the texel density over the mean is 1.6 and 0.4.
    EXPECT_NEAR(r.l2_stretch, 1.25, 1e-6);
    EXPECT_NEAR(r.area_distortion, 2.05, 1e-5);
    EXPECT_NEAR(r.angle_distortion, 1, 1e-6);
}

TEST(Measure, OverlapsAreCountedInTexels) {
    const mesh::TriangleMesh two = quads(kTwoSquares, {{0, 1, 2, 3}, {4, 5, 6, 7}});
    const AtlasReport r = measure(two, rectangles({{0, 0, 0.5f, 0.5f}, {0.25f, 0.25f, 0.75f, 0.75f}}, 1024));
    EXPECT_EQ(r.overlapping_texels, 65536u);
    EXPECT_DOUBLE_EQ(r.utilisation, (2 * 512.0 * 512 - 65536) / 1024 / 1024);
    EXPECT_EQ(r.smallest_gap, 0);
}

TEST(Measure, GapsAreRoundedDown) {
    const mesh::TriangleMesh two = quads(kTwoSquares, {{0, 1, 2, 3}, {4, 5, 6, 7}});
    const auto gap = [&](float x, float y) {
        return measure(two, rectangles(
                                {{0, 0, 0.25f, 0.25f}, {0.25f + x / 1024, y / 1024, 0.5f + x / 1024, 0.25f + y / 1024}},
                                1024))
            .smallest_gap;
    };
    EXPECT_EQ(gap(3.5f, 0), 3);
    EXPECT_EQ(gap(4, 0), 4);
    EXPECT_EQ(gap(3, 256 + 3), 4);  // across the corner: 3√2
    EXPECT_EQ(gap(70, 0), 64);
}

TEST(Measure, FlipsAndTrianglesWithoutArea) {
    const mesh::TriangleMesh two = quads(kTwoSquares, {{0, 1, 2, 3}, {4, 5, 6, 7}});
    Atlas atlas = rectangles({{0, 0, 0.25f, 0.25f}, {0.5f, 0.5f, 0.75f, 0.75f}}, 64);
    std::swap(atlas.corner_uvs[1], atlas.corner_uvs[2]);
    atlas.corner_uvs[5] = atlas.corner_uvs[4];
    EXPECT_EQ(measure(two, atlas).flips, 1u);
    EXPECT_EQ(measure(two, atlas).zero_area_triangles, 1u);
    atlas.corner_uvs[5] = Vec2f(NAN);
    EXPECT_EQ(measure(two, atlas).zero_area_triangles, 1u);
}

// What is not finite counts as having no room; the rest is measured as if it were alone.
TEST(Measure, UvsThatAreNotNumbersAreLeftOut) {
    std::vector<Vec3f> p = kTwoSquares;
    for (const Vec3f& q : kTwoSquares) p.push_back(q + Vec3f(0, 2, 0));
    const mesh::TriangleMesh three = quads(p, {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}});
    const float infinite = std::numeric_limits<float>::infinity();
    for (const float bad : {NAN, infinite, -infinite}) {
        Atlas atlas = rectangles({{0, 0, 0.25f, 0.25f}, {0.2578125f, 0, 0.5f, 0.25f}, {0.75f, 0.75f, 1, 1}}, 1024);
        for (const std::size_t corner : {12u, 16u}) atlas.corner_uvs[corner].x = bad;
        const AtlasReport r = measure(three, atlas);
        EXPECT_EQ(r.zero_area_triangles, 2u);
        EXPECT_EQ(r.flips + r.overlapping_texels, 0u);
        EXPECT_EQ(r.smallest_gap, 8);
        EXPECT_DOUBLE_EQ(r.utilisation, (256.0 * 256 + 248 * 256) / 1024 / 1024);
        EXPECT_TRUE(std::isfinite(r.l2_stretch) && std::isfinite(r.linf_stretch));
        EXPECT_TRUE(std::isfinite(r.angle_distortion) && std::isfinite(r.area_distortion));
    }
}

double twice_signed_area(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const Vec2 u = Vec2(b) - Vec2(a), v = Vec2(c) - Vec2(a);
    return u.x * v.y - u.y * v.x;
}

// Triangles that share edges split the texels among them: none is covered twice, none is
// left out, at page sizes that are no powers of two and with corners on texel centres.
TEST(Measure, NeighboursNeverShareATexel) {
    Random random(5);
    for (const std::uint32_t size : {7u, 64u, 333u}) {
        constexpr int n = 12;
        std::vector<Vec2f> p;
        std::vector<std::array<int, 3>> faces;
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) p.push_back(Vec2f(float(i) / n, float(j) / n));
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const int a = j * (n + 1) + i;
                faces.push_back({a, a + 1, a + n + 2});
                faces.push_back({a, a + n + 2, a + n + 1});
            }
        for (int j = 1; j < n; ++j)
            for (int i = 1; i < n; ++i) {
                Vec2f& q = p[std::size_t(j * (n + 1) + i)];
                const Vec2f before = q;
                const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3);
                q += Vec2f(float(x), float(y)) / float(n);
                if (random.uniform() < 0.3) q = (glm::floor(q * float(size)) + 0.5f) / float(size);
                const bool folded = std::any_of(faces.begin(), faces.end(), [&](const auto& f) {
                    return twice_signed_area(p[f[0]], p[f[1]], p[f[2]]) < 1e-6;
                });
                if (folded) q = before;
            }
        std::vector<Vec2f> uvs;
        for (const auto& f : faces)
            for (const int v : f) uvs.push_back(p[std::size_t(v)]);
        const Coverage coverage = cover(uvs, {}, size);
        EXPECT_EQ(coverage.covered, std::size_t{size} * size);
        EXPECT_EQ(coverage.twice, 0u);
    }
}

}  // namespace
}  // namespace tuft::atlas
