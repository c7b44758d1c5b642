#include "atlas/charts/equal_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "atlas/seams/half_edges.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "test_mesh.h"

namespace tuft::atlas {
namespace {

using mesh::TriangleMesh;
using test::Triangles;

/// An open surface without symmetry.
TriangleMesh blob() {
    return test::grid_mesh(24, 16, true, false, [](double u, double v) {
        const double angle = 2 * std::numbers::pi * u;
        const double r = 0.05 * (1 + 0.3 * std::sin(angle) + 0.2 * v * std::cos(2 * angle + 1) - 0.3 * v * v);
        return Vec3(r * std::cos(angle), r * std::sin(angle), 0.08 * v);
    });
}

/// Several bodies side by side as one mesh.
class Assembly {
  public:
    /// Adds a body with its points moved; its triangles come in chance order and begin at chance corners. A mirrored
    /// body is turned inside out, so that its front stays outside.
    void add(const TriangleMesh& body, const std::function<Vec3(const Vec3&)>& moved, bool mirrored) {
        const auto first = static_cast<std::uint32_t>(positions_.size());
        for (const Vec3f& p : body.positions) positions_.push_back(Vec3f(moved(Vec3(p))));
        Triangles own = body.triangles;
        for (std::size_t i = own.size(); i > 1; --i)
            std::swap(own[i - 1], own[static_cast<std::size_t>(random_.uniform() * static_cast<double>(i))]);
        for (auto& t : own) {
            if (mirrored) std::swap(t[0], t[1]);
            std::rotate(t.begin(), t.begin() + static_cast<int>(3 * random_.uniform()), t.end());
            for (std::uint32_t& v : t) v += first;
            triangles_.push_back(t);
        }
    }

    TriangleMesh mesh() const { return test::finish_mesh(positions_, triangles_); }

  private:
    Random random_{7};
    std::vector<Vec3f> positions_;
    Triangles triangles_;
};

Vec3 turned(const Vec3& p) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    return {c * p.x - s * p.z + 0.3, p.y, s * p.x + c * p.z};
}

/// A blob, the same moved, its mirror image, and a larger one.
TriangleMesh blobs() {
    Assembly assembly;
    assembly.add(
        blob(), [](const Vec3& p) { return p; }, false);
    assembly.add(blob(), turned, false);
    assembly.add(
        blob(),
        [](const Vec3& p) {
            return turned({-p.x, p.y, p.z - 0.3});
        },
        true);
    assembly.add(
        blob(), [](const Vec3& p) { return 1.05 * p + Vec3(0, 0.4, 0); }, false);
    return assembly.mesh();
}

double edge_length(const TriangleMesh& m, std::uint32_t h) {
    return glm::length(m.position(h / 3, static_cast<int>(h % 3)) -
                       m.position(h / 3, static_cast<int>(next_half(h) % 3)));
}

TEST(EqualParts, AreFoundMovedAndMirroredInAnyOrder) {
    const TriangleMesh m = blobs();
    const std::size_t n = blob().n_triangles();
    const std::vector<std::uint32_t> twin = twin_half_edges(m);
    const EqualParts parts = find_equal_parts(m, twin);
    ASSERT_TRUE(parts.any());
    EXPECT_EQ(parts.kept.size(), 2 * n);  // one blob and the larger one
    for (std::uint32_t t = 0; t < m.n_triangles(); ++t) {
        EXPECT_EQ(parts.part[t], t / n);
        EXPECT_EQ(parts.mirrored[t], t / n == 2) << t;
        EXPECT_EQ(parts.source[3 * t] / 3 / n, t / n == 3 ? 3 : 0);
    }
    std::set<std::pair<std::size_t, std::uint32_t>> used;
    for (std::uint32_t h = 0; h < twin.size(); ++h) {
        const std::uint32_t s = parts.source[h];
        EXPECT_TRUE(used.insert({h / (3 * n), s}).second) << "one half-edge of each part for one of the first";
        // Floats of positions up to 0.5 m are off by 3e-8 m.
        EXPECT_NEAR(edge_length(m, h), edge_length(m, s), 1e-7);
        EXPECT_EQ(twin[h] == kNone ? kNone : parts.source[twin[h]], twin[s]);
    }
}

TEST(EqualParts, DifferWhereOneVertexDoes) {
    Assembly assembly;
    TriangleMesh dented = blob();
    dented.positions[200] *= 0.97f;
    assembly.add(
        blob(), [](const Vec3& p) { return p; }, false);
    assembly.add(dented, turned, false);
    const TriangleMesh m = assembly.mesh();
    EXPECT_FALSE(find_equal_parts(m, twin_half_edges(m)).any());
}

// A requested seam divides a part, and so its copies only where it divides them too.
TEST(EqualParts, AreThoseThatSeamsLeave) {
    Assembly assembly;
    assembly.add(
        blob(), [](const Vec3& p) { return p; }, false);
    assembly.add(blob(), turned, false);
    const TriangleMesh m = assembly.mesh();
    std::vector<std::uint32_t> twin = twin_half_edges(m);
    std::uint32_t h = 0;
    while (twin[h] == kNone) ++h;
    twin[twin[h]] = kNone;
    twin[h] = kNone;
    EXPECT_FALSE(find_equal_parts(m, twin).any());
}

double uv_length(const Atlas& atlas, std::uint32_t h) {
    return glm::length(Vec2(atlas.corner_uvs[h]) - Vec2(atlas.corner_uvs[next_half(h)]));
}

TEST(EqualParts, HaveTheSameChartsOnTexelsOfTheirOwn) {
    const TriangleMesh m = blobs();
    const EqualParts parts = find_equal_parts(m, twin_half_edges(m));
    std::vector<Vec2f> first;
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        UnwrapOptions options;
        options.size = 1024;
        options.cutting = Cutting::never;  // which halves charts one by one
        const Unwrapped u = unwrap(m, options);
        EXPECT_EQ(u.report.flips, 0u);
        EXPECT_EQ(u.report.zero_area_triangles, 0u);
        EXPECT_EQ(u.report.overlapping_texels, 0u);
        EXPECT_GE(u.report.smallest_gap, static_cast<int>(u.atlas.gutter));
        // Rounded to steps of 2⁻²⁴ at both ends, each by half a step in u and in v.
        for (std::uint32_t h = 0; h < parts.source.size(); ++h)
            EXPECT_NEAR(uv_length(u.atlas, h), uv_length(u.atlas, parts.source[h]), 4 * std::exp2(-24));
        if (first.empty()) first = u.atlas.corner_uvs;
        EXPECT_EQ(first, u.atlas.corner_uvs) << threads;
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::atlas
