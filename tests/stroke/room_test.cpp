#include "stroke/hand/room.h"

#include <gtest/gtest.h>

#include "grids.h"

namespace tuft::stroke {
namespace {

constexpr Vec3 kFront{0, 1, 0};
// A place or a size found on the grid of 129 rays is off by two cells at most: one for each edge.
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

TEST(Room, TheMiddleOfASphereHasRoomForWhatIsASmallerPartOfIt) {
    const TriangleMesh m = make_sphere();
    const SurfaceQuery query(m);
    const auto room = find_room(query, kFront, {0.05, 0.03});
    ASSERT_TRUE(room);
    EXPECT_EQ(room->scale, 1);
    EXPECT_NEAR(glm::distance(room->at.position, Vec3{0, -0.05, 0}), 0, 0.1 * kGrid);
    EXPECT_GT(-room->normal.y, 0.999);
    // As wide as the sphere it would bend round it.
    const auto all = find_room(query, kFront, {0.1, 0.1});
    ASSERT_TRUE(all);
    EXPECT_LT(all->scale, 0.75) << "a square in the circle is 0.71 wide";
    EXPECT_GT(all->scale, 0.45);
}

TEST(Room, AHoleIsPassedBy) {
    // A frame 100 mm wide and 60 high about a hole of 20 x 20 in its middle.
    const TriangleMesh m = walls({{-0.05, -0.01, -0.03, 0.03, 0}, {0.01, 0.05, -0.03, 0.03, 0}, {-0.01, 0.01, -0.03, -0.01, 0}, {-0.01, 0.01, 0.01, 0.03, 0}});
    const SurfaceQuery query(m);
    const auto room = find_room(query, kFront, {0.03, 0.03});
    ASSERT_TRUE(room);
    EXPECT_EQ(room->scale, 1);
    EXPECT_NEAR(std::abs(room->at.position.x), 0.025, 0.2 * kGrid) << "beside the hole, as near to the middle as it can be";
    EXPECT_LT(std::abs(room->at.position.z), 0.015);
}

TEST(Room, AStepIsNotCrossed) {
    // Two thirds of the front stand 30 mm behind the rest.
    const TriangleMesh m = walls({{-0.06, -0.02, -0.02, 0.02, 0}, {-0.02, 0.06, -0.02, 0.02, 0.03}});
    const SurfaceQuery query(m);
    const auto room = find_room(query, kFront, {0.05, 0.02});
    ASSERT_TRUE(room);
    EXPECT_EQ(room->scale, 1);
    EXPECT_NEAR(room->at.position.x, 0.005, 0.24 * kGrid);
    EXPECT_NEAR(room->at.position.y, 0.03, 1e-6);
}

TEST(Room, AShutLineIsNotAnEdge) {
    const TriangleMesh m = walls({{-0.1, -0.001, -0.05, 0.05, 0}, {0.001, 0.1, -0.05, 0.05, 0}, {-0.001, 0.001, -0.05, 0.05, 0.02}});
    const SurfaceQuery query(m);
    const auto room = find_room(query, kFront, {0.12, 0.06});
    ASSERT_TRUE(room);
    EXPECT_EQ(room->scale, 1);
    EXPECT_NEAR(room->at.position.x, 0, 0.2 * kGrid);
}

TEST(Room, ADrawingShrinksToWhatThereIs) {
    const TriangleMesh m = walls({{-0.1, 0.1, -0.01, 0.01, 0}});
    const SurfaceQuery query(m);
    const auto room = find_room(query, kFront, {0.06, 0.06});
    ASSERT_TRUE(room);
    // Room for a third; sizes go by fourth roots of two, and one of 129 rays is rounded away.
    EXPECT_LE(room->scale, 1.0 / 3 * (1 + 2 * kGrid));
    EXPECT_GT(room->scale, 1.0 / 3 * std::exp2(-0.25) * (1 - 2 * kGrid));
    EXPECT_FALSE(find_room(query, -kFront, {0.06, 0.02})) << "its back is not painted on";
}

}  // namespace
}  // namespace tuft::stroke
