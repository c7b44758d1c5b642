#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <tuple>

#include "contact/near_vertices.h"
#include "contact/obb.h"
#include "contact/sphere.h"
#include "core/random.h"
#include "paths.h"
#include "shapes.h"

namespace tuft::contact {
namespace {

/// Point sets of tests/data/contact/minsphere.csv, made by the same linear congruential draws.
std::vector<Vec3> point_set(const std::string& kind, int n, std::uint32_t seed) {
    std::uint32_t x = seed;
    const auto draw = [&] {
        x = 1664525u * x + 1013904223u;
        return x / 4294967296.0;
    };
    constexpr double pi = std::numbers::pi;
    std::vector<Vec3> out;
    for (int i = 0; i < n; ++i) {
        const double a = draw(), b = draw(), c = draw();
        if (kind == "cube") out.push_back({a, b, c});
        if (kind == "box") out.push_back({4 * a, b, 0.1 * c});
        if (kind == "needle") out.push_back({a, 0.01 * b, 0.01 * c});
        if (kind == "sphere") {
            const double z = 2 * a - 1, rho = std::sqrt(1 - z * z);
            out.push_back({rho * std::cos(2 * pi * b), rho * std::sin(2 * pi * b), z});
        }
        if (kind == "brush") {
            const double r = 4 * (1 - a), R = 80 / pi, t = a * pi / 2, w = 2 * pi * b;
            out.push_back({R * (1 - std::cos(t)) + r * std::cos(w) * std::cos(t), r * std::sin(w),
                           -R * std::sin(t) + r * std::cos(w) * std::sin(t)});
        }
        if (kind == "hook") {
            const double r = 4 * (1 - 0.8 * a), t = a * 260 * pi / 180, w = 2 * pi * b;
            out.push_back({(9 + r * std::cos(w)) * std::cos(t), (9 + r * std::cos(w)) * std::sin(t), r * std::sin(w)});
        }
    }
    return out;
}

TEST(ExpandBall, MatchesTheReferenceTableAndItsProvedBounds) {
    // Exact radii there: primal-dual certificate, error 2e-15. The iteration counts depend on ties
    // only, the radii agree to rounding.
    std::ifstream file(test_data() + "/contact/minsphere.csv");
    ASSERT_TRUE(file);
    std::string line;
    std::getline(file, line);
    int rows = 0;
    while (std::getline(file, line)) {
        std::vector<std::string> c;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) c.push_back(cell);
        const std::vector<Vec3> points = point_set(c[0], std::stoi(c[1]), std::stoul(c[2]));
        const double exact = std::stod(c[6]);
        SCOPED_TRACE(line.substr(0, 20));
        for (const int k : {0, 1}) {
            const double epsilon = k ? 1e-3 : 1e-2;
            const Sphere s = expand_ball(points, epsilon);
            EXPECT_NEAR(s.r_start, std::stod(c[8]), 1e-12 * exact);
            EXPECT_NEAR(s.r_expanded, std::stod(c[9 + 3 * k]), 1e-9 * exact);
            EXPECT_NEAR(s.radius, std::stod(c[10 + 3 * k]), 1e-9 * exact);
            EXPECT_EQ(s.iterations, std::stoi(c[11 + 3 * k]));
            EXPECT_LE(s.r_expanded, exact * (1 + 1e-12));
            EXPECT_GE(s.radius, exact * (1 - 1e-12));
            EXPECT_LE(s.radius, (1 + epsilon) * exact * (1 + 1e-12));
            for (const Vec3& p : points) EXPECT_LE(glm::length(p - s.centre), s.radius * (1 + 1e-12));
        }
        ++rows;
    }
    EXPECT_EQ(rows, 36);
}

TEST(ExpandBall, PointSetsAreThoseOfTheReference) {
    for (const auto& [name, kind, n, seed] : {std::tuple{"minsphere_points_brush_200_4.csv", "brush", 200, 4u},
                                              {"minsphere_points_cube_50_3.csv", "cube", 50, 3u}}) {
        std::ifstream file(test_data() + "/contact/" + name);
        ASSERT_TRUE(file);
        std::string line;
        std::getline(file, line);
        for (const Vec3& p : point_set(kind, n, seed)) {
            Vec3 q{0};
            char comma;
            ASSERT_TRUE(file >> q.x >> comma >> q.y >> comma >> q.z);
            EXPECT_NEAR(glm::length(p - q), 0, 1e-12);  // 15 digits
        }
    }
}

TEST(ExpandBall, TakesAnything) {
    EXPECT_EQ(expand_ball({}).radius, 0);
    const Vec3 p{1, 2, 3};
    EXPECT_EQ(expand_ball(std::span(&p, 1)).radius, 0);
    const std::vector<Vec3> same(5, p);
    EXPECT_EQ(expand_ball(same).centre, p);
}

TEST(Obb, HoldsItsPointsTightly) {
    Random random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Quat q = glm::normalize(Quat{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0.1});
        std::vector<Vec3> points;
        for (int i = 0; i < 4000; ++i)
            points.push_back(q * Vec3{random.uniform(-5, 5), random.uniform(-2, 2), random.uniform(-1, 1)} +
                             Vec3{3, 4, 5});
        const Obb box = obb_of(points);
        for (const Vec3& p : points) {
            const Vec3 local = glm::abs((p - box.centre) * box.axes);
            for (int k = 0; k < 3; ++k) EXPECT_LE(local[k], box.half[k] * (1 + 1e-12));
        }
        // 4000 points fix the axes to about 2 %.
        EXPECT_NEAR(box.half[0], 5, 0.2);
        EXPECT_NEAR(box.half[1], 2, 0.3);
        EXPECT_NEAR(box.half[2], 1, 0.3);
        EXPECT_NEAR(glm::determinant(box.axes), 1, 1e-12);
    }
}

TEST(Obb, OverlapAgreesWithSampledPoints) {
    Random random(4);
    int met = 0, apart = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const auto box = [&] {
            const Quat q = glm::normalize(
                Quat{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
            Obb b;
            b.axes = glm::mat3_cast(q);
            b.centre = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
            b.half = {random.uniform(0.1, 1.5), random.uniform(0.1, 1.5), random.uniform(0.1, 1.5)};
            return b;
        };
        const Obb a = box(), b = box();
        // Alternating projections between two convex sets reach their distance.
        const auto clamp_to = [](const Obb& o, const Vec3& p) {
            return o.centre + o.axes * glm::clamp((p - o.centre) * o.axes, -o.half, o.half);
        };
        Vec3 p = b.centre, q = p;
        for (int i = 0; i < 5000; ++i) {
            q = clamp_to(a, p);
            p = clamp_to(b, q);
        }
        const double distance = glm::length(p - q);
        if (distance > 1e-3) {
            EXPECT_FALSE(overlap(a, b));
            ++apart;
        } else if (distance < 1e-9) {
            EXPECT_TRUE(overlap(a, b));
            ++met;
        }
    }
    EXPECT_GT(met, 50);
    EXPECT_GT(apart, 50);
}

TEST(WeightedDistance, IsTheFormulaAndExactOnAPlane) {
    const Quat q = glm::angleAxis(0.7, glm::normalize(Vec3{1, 2, 3}));
    const mesh::TriangleMesh m = shapes::moved(shapes::sheet(0.1, 37), q, {0.01, 0.02, 0.03});
    const mesh::SurfaceQuery query(m);
    Random random(5);
    for (int i = 0; i < 50; ++i) {
        const double height = random.uniform(-0.002, 0.004);
        const Vec3 tip =
            q * Vec3{random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), height} + Vec3{0.01, 0.02, 0.03};
        const WeightedDistance d = weighted_distance(query, tip, tip + q * Vec3{0, 0, 0.1});
        ASSERT_TRUE(d.found);
        ASSERT_EQ(d.vertices.size(), 8u);
        EXPECT_NEAR(d.distance, height, 1e-8);  // positions are single precision
        EXPECT_NEAR(glm::length(d.normal - q * Vec3{0, 0, 1}), 0, 1e-5);
        EXPECT_NEAR(glm::dot(snap_tip(tip, d) - Vec3{0.01, 0.02, 0.03}, q * Vec3{0, 0, 1}), 0, 1e-8);
        double sum = 0, weights = 0;
        for (const auto& v : d.vertices) {
            const double w = 1 - v.distance / d.vertices.back().distance;
            sum += w * glm::dot(v.normal, tip - v.position);
            weights += w;
        }
        EXPECT_NEAR(d.distance, sum / weights, 1e-15);
    }
}

TEST(WeightedDistance, ErrorOnASphereFallsWithTheSquareOfTheSpacing) {
    // d_w - d is about κ h²/2 times a constant of the pattern: a quarter at half the spacing.
    constexpr double kRadius = 0.05;
    double error[3];
    for (int level = 0; level < 3; ++level) {
        const int n = 40 << level;
        const mesh::TriangleMesh m = shapes::bowl(kRadius, n);
        const mesh::SurfaceQuery query(m);
        Random random(6);
        double sum = 0;
        for (int i = 0; i < 300; ++i) {
            const double phi = random.uniform(0, 6.28), theta = random.uniform(2.0, 2.4);
            const Vec3 out{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            const Vec3 tip = (kRadius - 0.0002) * out;
            sum += std::abs(weighted_distance(query, tip, Vec3{0}).distance - 0.0002);
        }
        error[level] = sum / 300;
        const double h = kRadius * std::numbers::pi / 2 / n;
        EXPECT_LT(error[level], 1.5 * h * h / kRadius);
    }
    EXPECT_NEAR(error[0] / error[1], 4, 1);
    EXPECT_NEAR(error[1] / error[2], 4, 1);
}

TEST(WeightedDistance, IsContinuousWhileTheVertexSetChanges) {
    const mesh::TriangleMesh m = shapes::bowl(0.05, 60);
    const mesh::SurfaceQuery query(m);
    double before = 0, worst = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i <= kSteps; ++i) {
        const double phi = 0.4 * i / kSteps;
        const Vec3 tip = 0.0485 * Vec3{std::sin(2.2) * std::cos(phi), std::sin(2.2) * std::sin(phi), std::cos(2.2)};
        const double d = weighted_distance(query, tip, Vec3{0}).distance;
        if (i > 0) worst = std::max(worst, std::abs(d - before));
        before = d;
    }
    // 1 µm of travel per step; slope of d against travel stays below 1.
    EXPECT_LT(worst, 1e-6);
}

TEST(EffectivePatch, TakesTheFacingConnectedSideOnly) {
    const mesh::TriangleMesh m = shapes::plate({0.05, 0.05, 0.0005}, 50);
    const mesh::SurfaceQuery query(m);
    const Sphere sphere{{0.01, 0.01, 0.003}, 0.012};
    const auto under = query.closest_point(sphere.centre);
    ASSERT_TRUE(under);
    const EffectivePatch patch = effective_patch(m, under->triangle, sphere, {0, 0, 0.1});
    ASSERT_GT(patch.vertices.size(), 20u);
    for (const std::uint32_t v : patch.vertices) {
        EXPECT_GT(m.positions[v].z, 0);
        EXPECT_LE(glm::length(Vec3(m.positions[v]) - sphere.centre), sphere.radius);
    }
    // Every vertex of the upper side within the sphere is there.
    std::size_t expected = 0;
    for (const Vec3f& p : m.positions) expected += p.z > 0 && glm::length(Vec3(p) - sphere.centre) <= sphere.radius;
    EXPECT_EQ(patch.vertices.size(), expected);
    EXPECT_NEAR(patch.normal.z, 1, 1e-12);
    // The area of the disc cut from the plane, to the vertices' 2 mm.
    const double disc = std::numbers::pi * (0.012 * 0.012 - 0.0025 * 0.0025);
    EXPECT_NEAR(patch.area, disc, 0.2 * disc);
}

}  // namespace
}  // namespace tuft::contact
