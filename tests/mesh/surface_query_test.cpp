#include "mesh/query/surface_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>

#include "core/random.h"
#include "core/system/parallel.h"

namespace tuft::mesh {
namespace {

void finish(TriangleMesh& mesh) {
    mesh.bounds = {};
    for (const Vec3f& p : mesh.positions) mesh.bounds.add(Vec3(p));
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 n = glm::normalize(
            glm::cross(mesh.position(t, 1) - mesh.position(t, 0), mesh.position(t, 2) - mesh.position(t, 0)));
        for (int k = 0; k < 3; ++k) mesh.corner_normals.emplace_back(n);
    }
    mesh.neighbours.assign(3 * mesh.n_triangles(), kNone);
}

/// Loose triangles of all shapes, slivers among them, in a 0.1 m cube.
TriangleMesh random_triangles(int n, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    for (int t = 0; t < n; ++t) {
        const Vec3 c{random.uniform(0, 0.1), random.uniform(0, 0.1), random.uniform(0, 0.1)};
        const double size = 0.02 * std::pow(random.uniform(), 2) + 1e-4;
        std::array<std::uint32_t, 3> triangle{};
        for (int k = 0; k < 3; ++k) {
            triangle[k] = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.emplace_back(
                c + size * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) * 0.1});
        }
        mesh.triangles.push_back(triangle);
    }
    finish(mesh);
    return mesh;
}

TriangleMesh grid(int n, double side) {
    TriangleMesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(side * i / n, side * j / n, 0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    finish(mesh);
    return mesh;
}

/// Distance to a triangle without the region logic: the smallest of the plane's foot,
/// if inside, and the three segments.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto segment = [&](const Vec3& s, const Vec3& e) {
        const double u = glm::clamp(glm::dot(p - s, e - s) / glm::dot(e - s, e - s), 0.0, 1.0);
        return glm::length(s + u * (e - s) - p);
    };
    double best = std::min({segment(a, b), segment(b, c), segment(c, a)});
    const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
    const Vec3 foot = p - glm::dot(p - a, n) * n;
    const bool inside = glm::dot(glm::cross(b - a, foot - a), n) >= 0 &&
                        glm::dot(glm::cross(c - b, foot - b), n) >= 0 && glm::dot(glm::cross(a - c, foot - c), n) >= 0;
    return inside ? std::min(best, std::abs(glm::dot(p - a, n))) : best;
}

TEST(SurfaceQuery, OfSomeTrianglesIsThatOfAMeshOfThem) {
    const TriangleMesh mesh = random_triangles(400, 11);
    std::vector<std::uint32_t> some;
    TriangleMesh alone = mesh;
    alone.triangles.clear(), alone.corner_normals.clear(), alone.neighbours.clear();
    for (std::uint32_t t = 0; t < mesh.n_triangles(); t += 3) {
        some.push_back(t);
        alone.triangles.push_back(mesh.triangles[t]);
        for (std::size_t k = 0; k < 3; ++k) alone.corner_normals.push_back(mesh.corner_normals[3 * t + k]);
    }
    alone.neighbours.assign(3 * alone.n_triangles(), kNone);
    const SurfaceQuery part(mesh, some), whole(alone), none(mesh, {});
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p{random.uniform(-0.05, 0.15), random.uniform(-0.05, 0.15), random.uniform(-0.05, 0.15)};
        const Vec3 d = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const auto here = part.closest_point(p), there = whole.closest_point(p);
        ASSERT_EQ(here->triangle, some[there->triangle]);
        ASSERT_EQ(here->position, there->position);
        const auto hit = part.ray(p, d), same = whole.ray(p, d);
        ASSERT_EQ(hit.has_value(), same.has_value());
        if (hit) {
            ASSERT_EQ(hit->triangle, some[same->triangle]);
        }
        const auto near = part.nearest_vertices(p, 4), also = whole.nearest_vertices(p, 4);
        ASSERT_EQ(near.size(), also.size());
        for (std::size_t k = 0; k < near.size(); ++k) ASSERT_EQ(near[k].index, also[k].index);
        ASSERT_FALSE(none.closest_point(p) || none.ray(p, d) || none.occluded(p, d, 0, 1));
    }
}

TEST(SurfaceQuery, ClosestPointMatchesBruteForce) {
    const TriangleMesh mesh = random_triangles(2000, 1);
    const SurfaceQuery query(mesh);
    Random random(2);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p{random.uniform(-0.05, 0.15), random.uniform(-0.05, 0.15), random.uniform(-0.05, 0.15)};
        double expected = 1e9;
        for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
            expected = std::min(expected,
                                distance_to_triangle(p, mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2)));
        const auto hit = query.closest_point(p);
        ASSERT_TRUE(hit);
        // Both in double; slivers cost some digits of the foot point.
        EXPECT_NEAR(hit->distance, expected, 1e-11);
        EXPECT_NEAR(glm::length(hit->position - p), hit->distance, 1e-12);
        EXPECT_GE(hit->b1, 0);
        EXPECT_GE(hit->b2, 0);
        EXPECT_LE(hit->b1 + hit->b2, 1 + 1e-12);
        EXPECT_FALSE(query.closest_point(p, expected * (1 - 1e-9)));
        EXPECT_TRUE(query.closest_point(p, expected * (1 + 1e-9)));
    }
}

TEST(SurfaceQuery, ClosestPointFarAwayAndOnTheSurface) {
    const TriangleMesh mesh = grid(16, 0.1);
    const SurfaceQuery query(mesh);
    const auto far = query.closest_point({0.03, 0.05, 250});
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->distance, 250, 1e-12);
    EXPECT_NEAR(far->position.x, 0.03, 1e-12);
    const auto on = query.closest_point({0.0301, 0.0502, 0}, 0);
    ASSERT_TRUE(on);
    EXPECT_NEAR(on->distance, 0, 1e-12);
    EXPECT_FALSE(query.closest_point({NAN, 0, 0}));
}

TEST(SurfaceQuery, TiesGoToTheLowestTriangle) {
    const TriangleMesh mesh = grid(8, 0.08);
    const SurfaceQuery query(mesh);
    // Above an inner grid point six triangles are equally near.
    const Vec3 vertex = Vec3(mesh.positions[3 * 9 + 4]);
    std::uint32_t lowest = kNone;
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            if (v == 3 * 9 + 4) lowest = std::min(lowest, t);
    const auto hit = query.closest_point(vertex + Vec3{0, 0, 0.01});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, lowest);
}

TEST(SurfaceQuery, NearestVerticesMatchBruteForce) {
    const TriangleMesh mesh = random_triangles(800, 8);
    const SurfaceQuery query(mesh);
    Random random(9);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p{random.uniform(-0.02, 0.12), random.uniform(-0.02, 0.12), random.uniform(-0.02, 0.12)};
        std::vector<std::pair<double, std::uint32_t>> all;
        for (std::uint32_t v = 0; v < mesh.n_vertices(); ++v)
            all.emplace_back(glm::length(Vec3(mesh.positions[v]) - p), v);
        std::sort(all.begin(), all.end());
        const auto found = query.nearest_vertices(p, 8);
        ASSERT_EQ(found.size(), 8u);
        for (int k = 0; k < 8; ++k) {
            EXPECT_EQ(found[k].index, all[k].second);
            EXPECT_EQ(found[k].distance, all[k].first);
        }
        EXPECT_EQ(query.nearest_vertices(p, 8, all[4].first).size(), 5u);
    }
}

TEST(SurfaceQuery, VertexNormalsComeFromEveryTriangleRoundThem) {
    // On a faceted roof the vertices of the ridge look straight up, whatever they are asked from.
    TriangleMesh mesh = grid(8, 0.08);
    for (Vec3f& p : mesh.positions) p.z = -std::abs(p.x - 0.04f);
    const SurfaceQuery query(mesh);
    for (const Vec3& p : {Vec3{0.039, 0.041, 0.002}, Vec3{0.05, 0.04, 0.001}, Vec3{0.03, 0.04, -0.02}})
        for (const NearVertex& v : query.nearest_vertices(p, 8))
            if (std::abs(v.position.x - 0.04) < 1e-6 && v.position.y > 0.001 && v.position.y < 0.079) {
                EXPECT_NEAR(std::abs(v.normal.z), 1, 1e-6);  // three facets on either side
            }
}

TEST(SurfaceQuery, RayMatchesBruteForce) {
    const TriangleMesh mesh = random_triangles(1500, 3);
    const SurfaceQuery query(mesh);
    Random random(4);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 origin{random.uniform(-0.05, 0.15), random.uniform(-0.05, 0.15), -0.05};
        const Vec3 direction = glm::normalize(Vec3{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1});
        double nearest = 1e9, margin = 1;
        for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
            const Vec3 a = mesh.position(t, 0), e1 = mesh.position(t, 1) - a, e2 = mesh.position(t, 2) - a;
            const Vec3 h = glm::cross(direction, e2);
            const double det = glm::dot(e1, h);
            const double u = glm::dot(origin - a, h) / det;
            const Vec3 q = glm::cross(origin - a, e1);
            const double v = glm::dot(direction, q) / det;
            const double s = glm::dot(e2, q) / det;
            margin = std::min(margin, std::abs(std::min({u, v, 1 - u - v})));
            if (u >= 0 && v >= 0 && u + v <= 1 && s > 0) nearest = std::min(nearest, s);
        }
        if (margin < 1e-3) continue;  // grazes an edge: single precision may decide either way
        const auto hit = query.ray(origin, direction);
        ASSERT_EQ(hit.has_value(), nearest < 1e8);
        EXPECT_EQ(query.occluded(origin, direction, 0, 10), hit.has_value());
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->distance, nearest, 1e-6);  // float barycentrics on triangles of 2 cm
        EXPECT_FALSE(query.occluded(origin, direction, 0, nearest - 1e-5));
    }
    EXPECT_GT(hits, 50);
}

TEST(SurfaceQuery, HitsBothSidesAndNoCracksBetweenTriangles) {
    const TriangleMesh mesh = grid(32, 0.1);
    const SurfaceQuery query(mesh);
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        // Aim at grid lines and grid points, where a leaky test would let rays through.
        const double x = 0.1 * (1 + random.bits() % 31) / 32;
        const double y = i % 2 ? 0.1 * (1 + random.bits() % 31) / 32 : random.uniform(0.001, 0.099);
        EXPECT_TRUE(query.ray({x, y, 0.05}, {0, 0, -1}));
        EXPECT_TRUE(query.ray({x, y, -0.05}, {0, 0, 1}));
    }
}

TEST(SurfaceQuery, EmptyMeshAnswersNothing) {
    const TriangleMesh mesh;
    const SurfaceQuery query(mesh);
    EXPECT_FALSE(query.closest_point({0, 0, 0}));
    EXPECT_FALSE(query.ray({0, 0, 0}, {0, 0, 1}));
}

TEST(SurfaceQuery, BuildingLeavesTheThreadsOfOthersAlone) {
    const TriangleMesh mesh = random_triangles(500, 6);
    const SurfaceQuery query(mesh);
    set_thread_count(4);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    parallel_for(100, 1, [&](std::size_t, std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
    });
    set_thread_count(0);
    EXPECT_GT(threads.size(), 1u);
}

}  // namespace
}  // namespace tuft::mesh
