#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "app/input/pointer.h"
#include "core/text/units.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/repair.h"

/// What a pointer makes of the scene: a wall over the place, and how far away the model is.
namespace tuft::app {
namespace {

/// A floor 400 mm square, and a roof 2 mm thick over the half of it where y > −10 mm, 20 mm above; metres.
mesh::TriangleMesh floor_and_roof() {
    const std::string obj =
        "v -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf 1 2 3 4\n"
        "v -200 -10 20\nv 200 -10 20\nv 200 200 20\nv -200 200 20\nv -200 -10 22\nv 200 -10 22\nv 200 200 22\n"
        "v -200 200 22\nf 8 7 6 5\nf 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
    return mesh::build_surface(mesh::read_obj({obj.begin(), obj.end()}, "roof.obj"), {.metres_per_unit = 1e-3}).mesh;
}

/// The poses of a stroke along x on the floor at `y`, seen from the front at 25°.
std::vector<brush::Pose> stroke_at(const mesh::SurfaceQuery& query, const brush::Preset& preset, double y) {
    const double low = 25 * kDegree;
    const Vec3 sight{0, std::cos(low), -std::sin(low)};
    PointerInput hand(query, preset, {});
    std::vector<brush::Pose> poses;
    const auto take = [&](const std::vector<StrokeStep>& steps) {
        for (const StrokeStep& step : steps) poses.insert(poses.end(), step.poses.begin(), step.poses.end());
    };
    for (int i = 0; i <= 100; ++i)
        take(hand.move({.ray = {Vec3(-0.03 + 6e-4 * i, y, 0) - 0.5 * sight, sight},
                        .view_right = {1, 0, 0},
                        .view_up = {0, std::sin(low), std::cos(low)},
                        .metres_per_pixel = 1e-4,
                        .time = 0.004 * i}));
    take(hand.lift());
    return poses;
}

// Upright it would stand in the roof, and its hair would paint that from within.
TEST(CrampedPointer, UnderARoofTheHolderLeansOutIntoTheOpen) {
    const mesh::TriangleMesh mesh = floor_and_roof();
    const mesh::SurfaceQuery query(mesh);
    const brush::Preset preset = brush::load_preset("wolf-medium");
    const std::vector<brush::Pose> poses = stroke_at(query, preset, 0);
    ASSERT_GT(poses.size(), 50u);
    for (const brush::Pose& pose : poses) {
        const Vec3 axis = pose.rotation * Vec3(0, 0, 1);
        EXPECT_TRUE(pose.position.z < 0.020 || pose.position.y < -0.010) << pose.time;
        const auto met = query.ray(pose.position, -axis, 0, 2 * preset.length);
        ASSERT_TRUE(met) << pose.time;
        EXPECT_NEAR(met->position.z, 0, 1e-9) << "the floor comes first along the holder, at " << pose.time;
    }
}

TEST(CrampedPointer, WhereItHasRoomItStandsUpright) {
    const mesh::TriangleMesh mesh = floor_and_roof();
    const mesh::SurfaceQuery query(mesh);
    const brush::Preset preset = brush::load_preset("wolf-medium");
    constexpr double kTipped = 0.13;  // radians that a clean stroke tips the holder ahead at first
    for (const brush::Pose& pose : stroke_at(query, preset, -0.06))
        EXPECT_GT((pose.rotation * Vec3(0, 0, 1)).z, std::cos(kTipped));
}

// A block 10 mm high, lower than the tuft is long, seen along its foot: lines at the holder's side begin within it and
// leave through its top.
TEST(CrampedPointer, BesideAStepItStandsUpright) {
    const std::string obj =
        "v -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf 1 2 3 4\n"
        "v -200 0 -1\nv 200 0 -1\nv 200 100 -1\nv -200 100 -1\nv -200 0 10\nv 200 0 10\nv 200 100 10\n"
        "v -200 100 10\nf 8 7 6 5\nf 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
    const mesh::TriangleMesh mesh =
        mesh::build_surface(mesh::read_obj({obj.begin(), obj.end()}, "step.obj"), {.metres_per_unit = 1e-3}).mesh;
    const mesh::SurfaceQuery query(mesh);
    const PointerInput hand(query, brush::load_preset("wolf-medium"), {});
    const double low = 30 * kDegree;
    const Vec3 sight{std::cos(low), 0, -std::sin(low)};
    const auto found = hand.find_surface({.ray = {Vec3(0, -0.002, 0) - 0.1 * sight, sight},
                                          .view_right = {0, -1, 0},
                                          .view_up = {std::sin(low), 0, std::cos(low)},
                                          .metres_per_pixel = 1e-4});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->position.z, 0, 1e-9);
    EXPECT_NEAR(found->normal.z, 1, 1e-9);
}

// Where a whole car is in view, 200 pixels a second are metres a second on it: no fast hand.
TEST(PointerSpeed, AHandIsAsFastAsItsCursorIsOnTheScreen) {
    PointerSettings s;
    s.dwell_effect = 0;
    constexpr double kFar = 5e-3, kSpeed = 200 * kFar;
    constexpr double kLost = 0.5 * 200 / stroke::kFastPixels;  // of the pressure, at 200 pixels a second
    const auto options = stroke::pressure_options(s, kFar);
    stroke::PressureState press{.started = true, .speed = kSpeed};
    EXPECT_NEAR(stroke::pressure_goal(press, options), s.pressure * (1 - kLost), 1e-12);
    EXPECT_NEAR(stroke::pressure_goal(press, stroke::pressure_options(s, 1e-4)), s.pressure * 0.5, 1e-12) << "near by";
}

}  // namespace
}  // namespace tuft::app
