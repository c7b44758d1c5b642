#include "mesh/repair/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace tuft::mesh {
namespace {

std::vector<std::array<std::uint32_t, 3>> cut(const std::vector<Vec3>& polygon) {
    EarBudget budget;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangulate(polygon, budget, triangles);
    EXPECT_FALSE(budget.ran_out);
    return triangles;
}

/// Sum of signed areas and of absolute areas, seen along `normal`: equal when no triangle is
/// turned over, and equal to the polygon's area when they neither overlap nor leave gaps.
struct Areas {
    double with_sign = 0, absolute = 0;
};
Areas areas(const std::vector<Vec3>& p, const Vec3& normal) {
    Areas sum;
    for (const auto& [a, b, c] : cut(p)) {
        const double area = 0.5 * glm::dot(glm::cross(p[b] - p[a], p[c] - p[a]), normal);
        sum.with_sign += area;
        sum.absolute += std::abs(area);
    }
    return sum;
}

TEST(Triangulate, ConvexQuadIsCutAlongTheShorterDiagonal) {
    const std::vector<Vec3> kite{{0, 0, 0}, {2, -1, 0}, {6, 0, 0}, {2, 1, 0}};
    const auto t = cut(kite);
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t[0], (std::array<std::uint32_t, 3>{0, 1, 3}));
}

TEST(Triangulate, ConcaveQuadIsCutInside) {
    const std::vector<Vec3> dart{{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        std::vector<Vec3> p = dart;
        std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(turn), p.end());
        const Areas a = areas(p, {0, 0, 1});
        EXPECT_DOUBLE_EQ(a.with_sign, 3);
        EXPECT_DOUBLE_EQ(a.absolute, 3);
    }
}

TEST(Triangulate, QuadWithACornerOnItsSideHasNoFlatHalf) {
    const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    for (const auto& [a, b, c] : cut(p)) EXPECT_GT(glm::cross(p[b] - p[a], p[c] - p[a]).z, 0.5);
}

TEST(Triangulate, StarsCombsAndSpiralsAreCovered) {
    std::vector<std::vector<Vec3>> polygons;
    std::vector<Vec3> star, comb, spiral;
    for (int i = 0; i < 50; ++i) {
        const double r = i % 2 ? 1 : 5, a = 6.283185307179586 * i / 50;
        star.emplace_back(r * std::cos(a), r * std::sin(a), 0);
    }
    for (int i = 0; i < 40; ++i) comb.emplace_back(i, i % 2 ? 10 : 1, 0);
    comb.emplace_back(40, 0, 0);
    comb.emplace_back(-1, 0, 0);
    std::reverse(comb.begin(), comb.end());
    for (int i = 0; i <= 100; ++i)
        spiral.emplace_back((2 + 0.1 * i) * std::cos(0.2 * i), (2 + 0.1 * i) * std::sin(0.2 * i), 0);
    for (int i = 100; i >= 0; --i)
        spiral.emplace_back((1 + 0.1 * i) * std::cos(0.2 * i), (1 + 0.1 * i) * std::sin(0.2 * i), 0);
    std::reverse(spiral.begin(), spiral.end());
    for (const auto& p : {star, comb, spiral}) {
        double shoelace = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 &a = p[i], &b = p[(i + 1) % p.size()];
            shoelace += 0.5 * (a.x * b.y - a.y * b.x);
        }
        const Areas a = areas(p, {0, 0, shoelace > 0 ? 1 : -1});
        EXPECT_NEAR(a.with_sign, std::abs(shoelace), 1e-9 * std::abs(shoelace));
        EXPECT_NEAR(a.absolute, std::abs(shoelace), 1e-9 * std::abs(shoelace));
    }
}

TEST(Triangulate, KeyholeLeavesTheHoleOpen) {
    // A square with a square hole, joined by a bridge that is passed twice.
    const std::vector<Vec3> p{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 0},
                              {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}, {3, 3, 0}};
    const Areas a = areas(p, {0, 0, 1});
    EXPECT_DOUBLE_EQ(a.with_sign, 72);
    EXPECT_DOUBLE_EQ(a.absolute, 72);
}

TEST(Triangulate, AnyOrientationInSpace) {
    Random random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 normal = glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
        const Frame frame = make_frame(Vec3(random.uniform(-9, 9)), normal);
        std::vector<Vec3> p;
        double shoelace = 0;
        for (int i = 0; i < 23; ++i) {  // star-shaped about its centre, so it is simple
            const double r = random.uniform(1, 5), a = 6.283185307179586 * i / 23;
            p.push_back({r * std::cos(a), r * std::sin(a), 0});
        }
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 &a = p[i], &b = p[(i + 1) % p.size()];
            shoelace += 0.5 * (a.x * b.y - a.y * b.x);
        }
        for (Vec3& q : p) q = frame.to_world(q);
        const Areas a = areas(p, normal);
        EXPECT_NEAR(a.with_sign, shoelace, 1e-12 * 100);
        EXPECT_NEAR(a.absolute, shoelace, 1e-12 * 100);
    }
}

TEST(Triangulate, PolygonsThatCrossThemselvesStillGiveAllTriangles) {
    Random random(4);
    for (std::size_t n = 3; n < 40; ++n) {
        std::vector<Vec3> p;
        for (std::size_t i = 0; i < n; ++i) p.emplace_back(random.uniform(), random.uniform(), random.uniform());
        EXPECT_EQ(cut(p).size(), n - 2);
        EXPECT_EQ(cut(std::vector<Vec3>(n, Vec3(1))).size(), n - 2);  // all in one place
    }
}

}  // namespace
}  // namespace tuft::mesh
