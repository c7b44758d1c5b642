#include "stroke/drawing/free_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "grids.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/repair.h"
#include "paths.h"

namespace tuft::stroke {
namespace {

// A place or a size found on the grid of 129 rays is off by two cells at most: one for each edge.
// In parts of a side of the view.
constexpr double kGrid = 1.0 / 129;

/// Upright rectangles that face -y: x from, x to, z from, z to, y.
TriangleMesh walls(const std::vector<std::array<double, 5>>& all) {
    TriangleMesh m;
    for (const auto& [x0, x1, z0, z1, y] : all) {
        const auto v = static_cast<std::uint32_t>(m.positions.size());
        for (const Vec3& p : {Vec3{x0, y, z0}, Vec3{x1, y, z0}, Vec3{x1, y, z1}, Vec3{x0, y, z1}}) {
            m.positions.push_back(Vec3f(p));
            m.bounds.add(p);
        }
        m.triangles.push_back({v, v + 1, v + 2});
        m.triangles.push_back({v, v + 2, v + 3});
        m.corner_normals.insert(m.corner_normals.end(), 6, Vec3f(0, -1, 0));
    }
    m.neighbours.assign(3 * m.triangles.size(), kNone);
    return m;
}

/// A normal deviate of the counter k (Box and Muller, of a multiplicative hash).
double normal(std::uint64_t k) {
    const auto uniform = [](std::uint64_t n) {
        n = (n + 1) * 0x9e3779b97f4a7c15ULL;
        n = (n ^ (n >> 31)) * 0xbf58476d1ce4e5b9ULL;
        return (static_cast<double>((n ^ (n >> 29)) >> 11) + 0.5) / 9007199254740992.0;
    };
    return std::sqrt(-2 * std::log(uniform(2 * k))) * std::cos(2 * std::numbers::pi * uniform(2 * k + 1));
}

TEST(FreeArea, OnASphereItIsInTheMiddle) {
    const TriangleMesh m = make_sphere();
    const SurfaceQuery query(m);
    for (const Side side : {Side::front, Side::back, Side::left, Side::right, Side::top, Side::bottom}) {
        const auto free = find_free_area(query, side, 1);
        ASSERT_TRUE(free) << side_name(side);
        EXPECT_NEAR(glm::distance(free->at.position, -0.05 * look_at_side(side)), 0, 0.2 * kGrid) << side_name(side);
        EXPECT_GT(-glm::dot(free->normal, look_at_side(side)), 0.999);
        EXPECT_LT(free->size.x, 0.0709) << "a square in the circle is 0.71 wide";
        EXPECT_GT(free->size.x, 0.045);
    }
}

TEST(FreeArea, AHoleIsPassedBy) {
    // A frame 100 mm wide and 60 high about a hole of 20 x 20, nearer to its right end.
    const TriangleMesh m = walls({{-0.05, 0.01, -0.03, 0.03, 0},
                                  {0.03, 0.05, -0.03, 0.03, 0},
                                  {0.01, 0.03, -0.03, -0.01, 0},
                                  {0.01, 0.03, 0.01, 0.03, 0}});
    const SurfaceQuery query(m);
    const auto free = find_free_area(query, Side::front, 1);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at.position.x, -0.02, 0.2 * kGrid) << "the whole wall beside the hole";
    EXPECT_NEAR(free->at.position.z, 0, 0.2 * kGrid);
    EXPECT_NEAR(free->size.x, 0.06, 0.3 * kGrid);
}

TEST(FreeArea, ALineTakesTheLengthOfALongWall) {
    const TriangleMesh m = walls({{-1.5, 1.5, -0.15, 0.15, 0}});
    const SurfaceQuery query(m);
    for (const double aspect : {10.0, 30.0, 300.0}) {
        const auto free = find_free_area(query, Side::front, aspect);
        ASSERT_TRUE(free);
        EXPECT_NEAR(free->size.x, 3, 2 * 3 * kGrid) << aspect;
    }
}

TEST(FreeArea, AStepIsNotCrossedAndTheLargerSideOfItIsTaken) {
    // Two thirds of the front stand 30 mm behind the rest.
    const TriangleMesh m = walls({{-0.06, -0.02, -0.02, 0.02, 0}, {-0.02, 0.06, -0.02, 0.02, 0.03}});
    const SurfaceQuery query(m);
    const auto free = find_free_area(query, Side::front, 2);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at.position.x, 0.02, 0.24 * kGrid);
    EXPECT_NEAR(free->at.position.y, 0.03, 1e-6);
    EXPECT_NEAR(free->size.x, 0.08, 0.4 * kGrid);
}

TEST(FreeArea, AShutLineIsNotAnEdge) {
    const TriangleMesh m =
        walls({{-0.1, -0.001, -0.05, 0.05, 0}, {0.001, 0.1, -0.05, 0.05, 0}, {-0.001, 0.001, -0.05, 0.05, 0.02}});
    const SurfaceQuery query(m);
    const auto free = find_free_area(query, Side::front, 2);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at.position.x, 0, 0.4 * kGrid);
    EXPECT_NEAR(free->size.x, 0.2, 0.6 * kGrid);
}

TEST(FreeArea, ItHasTheDrawingsShape) {
    const TriangleMesh m = walls({{-0.1, 0.1, -0.01, 0.01, 0}});
    const SurfaceQuery query(m);
    const auto square = find_free_area(query, Side::front, 1), wide = find_free_area(query, Side::front, 4);
    ASSERT_TRUE(square && wide);
    // A cell is 1.6 x 0.16 mm: two of them for the edges.
    EXPECT_NEAR(square->size.x, 0.02, 0.4 * kGrid);
    EXPECT_NEAR(wide->size.x, 0.08, 0.4 * kGrid);
    EXPECT_NEAR(square->at.position.x, 0, 0.4 * kGrid) << "the middle of all the places that are as good";
    EXPECT_FALSE(find_free_area(query, Side::back, 1)) << "its back is not painted on";
}

// The front of a car: lamps at both sides, larger than the bonnet between them, of which each has steps around it.
TEST(FreeArea, OnASymmetricModelItLiesInThePlaneOfSymmetry) {
    const auto front = [](double bonnet) {
        return walls({{-0.1, -0.04, -0.05, 0.05, 0},
                      {-0.04, -bonnet, -0.05, 0.05, 0.06},
                      {-bonnet, bonnet, -0.05, 0.05, 0.02},
                      {bonnet, 0.04, -0.05, 0.05, 0.06},
                      {0.04, 0.1, -0.05, 0.05, 0}});
    };
    const TriangleMesh wide = front(0.025), narrow = front(0.006);
    const SurfaceQuery over(wide), beside(narrow);
    const auto middle = find_free_area(over, Side::front, 1);
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->at.position.x, 0, 1e-6) << "50 of 60 mm: the rays of the middle column lie in the plane";
    EXPECT_NEAR(middle->size.x, 0.05, 2 * 0.2 * kGrid);
    const auto lamp = find_free_area(beside, Side::front, 1);
    ASSERT_TRUE(lamp);
    EXPECT_NEAR(std::abs(lamp->at.position.x), 0.07, 0.2 * kGrid) << "12 of 60 mm are too few";
}

TEST(FreeArea, OnAnAsymmetricModelItIsTheLargest) {
    const TriangleMesh m = walls({{-0.1, -0.025, -0.05, 0.05, 0}, {-0.025, 0.1, -0.05, 0.05, 0.02}});
    const SurfaceQuery query(m);
    const auto free = find_free_area(query, Side::front, 1);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at.position.x, 0.0375, 0.2 * kGrid) << "the middle of the larger part, not of the model";
}

// The shipped models of revolution, and the car, whose nose points to +x.
TEST(FreeArea, OnTheShippedModelsItIsInTheMiddle) {
    for (const auto& [name, side, axis] : {std::tuple{"bowl.ply", Side::front, 0},
                                           {"vase.ply", Side::front, 0},
                                           {"car.ply", Side::right, 1},
                                           {"car.ply", Side::left, 1},
                                           {"car.ply", Side::top, 1}}) {
        const TriangleMesh model =
            mesh::build_surface(mesh::read_polygon_file(source_folder() + "/models/" + name)).mesh;
        const SurfaceQuery query(model);
        for (const double aspect : {1.0, 2.0, 4.0}) {
            const auto free = find_free_area(query, side, aspect);
            ASSERT_TRUE(free) << name;
            EXPECT_NEAR(free->at.position[axis], 0, 1e-3) << name << " from the " << side_name(side) << ", " << aspect;
        }
    }
}

TEST(FreeArea, ACalmAreaIsPreferredToALargerRoughOne) {
    // A flat wall on the left, a larger one of pleats that lean by 30 degrees to the right of it.
    std::vector<std::array<double, 5>> all{{-0.1, 0, -0.05, 0.05, 0}};
    TriangleMesh m = walls(all);
    const double pleat = 0.004, deep = pleat * std::tan(0.52);
    for (int k = 0; k < 35; ++k)
        for (int half = 0; half < 2; ++half) {
            const double x0 = pleat * (k + 0.5 * half), x1 = x0 + 0.5 * pleat, y0 = half ? 0.5 * deep : 0,
                         y1 = half ? 0 : 0.5 * deep;
            const auto v = static_cast<std::uint32_t>(m.positions.size());
            for (const Vec3& p : {Vec3{x0, y0, -0.05}, Vec3{x1, y1, -0.05}, Vec3{x1, y1, 0.05}, Vec3{x0, y0, 0.05}}) {
                m.positions.push_back(Vec3f(p));
                m.bounds.add(p);
            }
            m.triangles.push_back({v, v + 1, v + 2});
            m.triangles.push_back({v, v + 2, v + 3});
            m.corner_normals.insert(m.corner_normals.end(), 6, Vec3f(0, -1, 0));
        }
    m.neighbours.assign(3 * m.triangles.size(), kNone);
    const SurfaceQuery query(m);
    const auto free = find_free_area(query, Side::front, 1);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at.position.x, -0.05, 0.012) << "within the flat wall";
}

/// Unit directions across the surface at the vertices.
std::vector<Vec3f> directions_across(const TriangleMesh& model) {
    const std::vector<Vec3f>& p = model.positions;
    std::vector<Vec3f> across(p.size(), Vec3f(0));
    for (const auto& t : model.triangles)
        for (const std::uint32_t v : t) across[v] += glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    for (Vec3f& a : across) a = glm::normalize(a);
    return across;
}

// Noise across the surface of a scan. Its triangles lean by 20 to 60 degrees; at the scale of a drawing the surface is
// as calm as before.
TEST(FreeArea, NoiseOfAScanLeavesItsSize) {
    TriangleMesh model = mesh::build_surface(mesh::read_polygon_file(source_folder() + "/models/bowl.ply")).mesh;
    const std::vector<Vec3f> clean = model.positions;
    const std::vector<Vec3f> across = directions_across(model);
    for (const auto& [side, aspect] : {std::pair{Side::front, 1.0}, {Side::inside, 1.0}}) {
        std::optional<FreeArea> smooth;
        for (const float noise : {0.0F, 0.3e-3F}) {
            for (std::size_t v = 0; v < clean.size(); ++v)
                model.positions[v] = clean[v] + noise * static_cast<float>(normal(v)) * across[v];
            const SurfaceQuery query(model);
            const auto free = find_free_area(query, side, aspect);
            ASSERT_TRUE(free) << noise;
            if (noise == 0) smooth = free;
            EXPECT_LT(std::abs(std::log(free->size.x / smooth->size.x)), std::log(1.3))
                << side_name(side) << ", " << aspect << ", " << noise << ": a person sees the same wall";
            EXPECT_LT(glm::distance(free->at.position, smooth->at.position), 0.1 * smooth->size.x) << noise;
        }
    }
}

// The ends of a car are narrow and have many edges: of their rays a tenth meets something else than its image does.
TEST(FreeArea, NoiseOfAScanLeavesItInThePlaneOfSymmetry) {
    TriangleMesh model = mesh::build_surface(mesh::read_polygon_file(source_folder() + "/models/car.ply")).mesh;
    constexpr float kNoise = 0.3e-3F;
    const std::vector<Vec3f> across = directions_across(model);
    model.bounds = {};
    for (std::size_t v = 0; v < across.size(); ++v) {
        if (!std::isfinite(across[v].x)) continue;
        model.positions[v] += kNoise * static_cast<float>(normal(v)) * across[v];
        model.bounds.add(Vec3(model.positions[v]));
    }
    const SurfaceQuery query(model);
    for (const Side side : {Side::right, Side::left})
        for (const double aspect : {0.5, 1.4}) {
            const auto free = find_free_area(query, side, aspect);
            ASSERT_TRUE(free) << side_name(side) << ", " << aspect;
            EXPECT_NEAR(free->at.position.y, 0, 4 * kNoise)
                << side_name(side) << ", " << aspect << ": the middle of a box that noise made wider on either side";
        }
}

}  // namespace
}  // namespace tuft::stroke
