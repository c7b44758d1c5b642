#include "mesh/query/exact_geodesics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "mesh/query/surface_query.h"
#include "mesh/repair/repair.h"

namespace tuft::mesh {
namespace {

constexpr std::size_t kMost = 1'000'000;

/// n × n squares of side 1/n metre in the plane, each halved, put into space; without those that
/// `gone` names.
TriangleMesh sheet(int n, const std::function<Vec3(Vec2)>& place, const std::function<bool(Vec2)>& gone = {}) {
    PolygonSoup soup;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) soup.points.push_back(1000.0 * place(Vec2(i, j) / double(n)));
    soup.polygon_start.push_back(0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            if (gone && gone(Vec2(i + 0.5, j + 0.5) / double(n))) continue;
            const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
            for (const std::uint32_t c :
                 {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
                soup.corners.push_back(c);
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()) - 3);
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        }
    return build_surface(std::move(soup), {.metres_per_unit = 1e-3}).mesh;
}

Vec3 flat(Vec2 p) {
    return Vec3(p, 0);
}

/// Bent along parallel lines into a zigzag of right angles, four pleats: lengths on it stay as they
/// were.
Vec3 pleated(Vec2 p) {
    const double x = 8 * p.x, pleat = std::floor(x / 2), in = x - 2 * pleat;
    return {(pleat + std::min(in, 1.0)) / 8, p.y,
            std::fmod(pleat, 2) == 0 ? std::max(in - 1, 0.0) / 8 : (1 - std::max(in - 1, 0.0)) / 8};
}

struct Stand {
    TriangleMesh mesh;
    SurfaceQuery query{mesh};
    ExactGeodesics geodesics;

    explicit Stand(TriangleMesh m) : mesh(std::move(m)) {}
    bool from(const Vec3& p, double radius = 2, double merge = 0) {
        const auto at = query.closest_point(p);
        return geodesics.spread(mesh, at->triangle, at->position, radius, {kMost, merge});
    }
    ExactGeodesics::Geodesic to(const Vec3& p) const {
        const auto at = query.closest_point(p);
        return geodesics.to(at->triangle, at->position);
    }
};

TEST(ExactGeodesics, AreStraightLinesOnWhatUnrollsToAPlane) {
    // Positions are kept in single precision, 6e-8 of a metre; origins lie a millionth of a
    // triangle off.
    for (Vec3 (*place)(Vec2) : {flat, pleated}) {
        Stand stand(sheet(16, place));
        Random random(3);
        for (int i = 0; i < 20; ++i) {
            const Vec2 a{random.uniform(0, 1), random.uniform(0, 1)};
            ASSERT_TRUE(stand.from(place(a)));
            for (int k = 0; k < 50; ++k) {
                const Vec2 b{random.uniform(0, 1), random.uniform(0, 1)};
                const auto path = stand.to(place(b));
                EXPECT_NEAR(path.length, glm::length(b - a), 1e-6);
                EXPECT_FALSE(path.bent);
                EXPECT_NEAR(glm::length(path.start_direction), 1, 1e-9);
                EXPECT_NEAR(glm::length(path.end_direction), 1, 1e-9);
                if (place == flat) {
                    EXPECT_LT(glm::length(path.start_direction - flat(b - a) / glm::length(b - a)), 1e-4);
                }
            }
        }
    }
}

TEST(ExactGeodesics, BendRoundTheCornerOfANotch) {
    // A quarter of the sheet is missing: from one arm to the other the path bends where its corner
    // stands.
    Stand stand(sheet(8, flat, [](Vec2 p) { return p.x > 0.5 && p.y > 0.5; }));
    const Vec2 corner{0.5, 0.5};
    ASSERT_TRUE(stand.from(flat({0.9, 0.3})));
    for (const Vec2 p : {Vec2{0.45, 0.95}, Vec2{0.4, 0.9}, Vec2{0.49, 0.6}}) {
        const auto path = stand.to(flat(p));
        EXPECT_TRUE(path.bent);
        EXPECT_NEAR(path.length, glm::length(corner - Vec2{0.9, 0.3}) + glm::length(p - corner), 1e-6);
        EXPECT_LT(glm::length(path.end_direction - flat(p - corner) / glm::length(p - corner)), 1e-5);
    }
    const auto straight = stand.to(flat({0.1, 0.5}));
    EXPECT_FALSE(straight.bent);
    EXPECT_NEAR(straight.length, std::hypot(0.8, 0.2), 1e-6);
}

TEST(ExactGeodesics, AreAsLongThereAsBack) {
    // Over a field of hills and hollows, with paths round many vertices of either kind.
    const auto hills = [](Vec2 p) { return Vec3(p, 0.06 * std::sin(19 * p.x) * std::cos(17 * p.y)); };
    Stand stand(sheet(32, hills));
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        const Vec3 a = hills({random.uniform(0, 1), random.uniform(0, 1)}),
                   b = hills({random.uniform(0, 1), random.uniform(0, 1)});
        ASSERT_TRUE(stand.from(a));
        const double there = stand.to(b).length;
        ASSERT_TRUE(stand.from(b));
        // Flat vertices throw no shadow, whose paths would be longer by 1e-8 of an edge each.
        EXPECT_NEAR(stand.to(a).length / there, 1, 1e-5);
        EXPECT_GE(there, glm::length(a - b) * (1 - 1e-3));
    }
}

TEST(ExactGeodesics, MergedWindowsGrowWithTheTrianglesAndPathsStay) {
    // A panel of a metre arched by 10 mm, cut finer and finer: each vertex parts the paths, so that a triangle is
    // crossed by ever more windows. Their sources lie within a micrometre, for its angle is less than 2π by 5e-7.
    const auto panel = [](Vec2 p) { return Vec3(p, 0.01 * std::sin(3 * p.x) * std::sin(3 * p.y)); };
    constexpr double kMerge = 1e-6;
    double parted_before = 0;
    for (const int n : {64, 128}) {
        Stand exact(sheet(n, panel)), merged(sheet(n, panel));
        const Vec3 origin = panel({0.4, 0.3});
        ASSERT_TRUE(exact.from(origin, 0.4));
        ASSERT_TRUE(merged.from(origin, 0.4, kMerge));
        const auto faces = static_cast<double>(exact.geodesics.n_faces());
        const double parted = static_cast<double>(exact.geodesics.n_windows()) / faces;
        EXPECT_GT(parted, 1.5 * parted_before);  // with the length of the paths in triangles, 2, but for those near by
        parted_before = parted;
        // Two of a triangle's edges let a window in, and some came too late to be joined.
        EXPECT_LT(static_cast<double>(merged.geodesics.n_windows()) / faces, 4) << n;
        Random random(7);
        for (int i = 0; i < 200; ++i) {
            const Vec3 p = panel({random.uniform(0.2, 0.6), random.uniform(0.1, 0.5)});
            const auto a = exact.to(p), b = merged.to(p);
            // Of the first order across the path, of the second along it; a path meets some hundred vertices.
            EXPECT_NEAR(a.length, b.length, kMerge);
            EXPECT_LT(a.length * glm::length(a.start_direction - b.start_direction), 100 * kMerge);
        }
    }
}

TEST(ExactGeodesics, EndAtTheRadiusAndAtTheMostWindows) {
    Stand stand(sheet(32, flat));
    ASSERT_TRUE(stand.from(flat({0.5, 0.5}), 0.2));
    EXPECT_NEAR(stand.to(flat({0.6, 0.6})).length, std::hypot(0.1, 0.1), 1e-6);
    EXPECT_TRUE(std::isinf(stand.to(flat({0.9, 0.5})).length));
    EXPECT_FALSE(stand.geodesics.spread(stand.mesh, 0, stand.mesh.position(0, 0), 10, {100, 0}));
    EXPECT_FALSE(stand.geodesics.spread(stand.mesh, kNone, Vec3{0}, 10, {kMost, 0}));
}

}  // namespace
}  // namespace tuft::mesh
