#include "stroke/gesture/symmetry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stroke/drawing/copies.h"

namespace tuft::stroke {
namespace {

const brush::Pose kPose{
    .position = {0.03, -0.02, 0.05}, .rotation = glm::normalize(Quat(0.8, 0.2, -0.5, 0.1)), .time = 1.5};

TEST(Symmetry, GroupsHaveTheirOrder) {
    EXPECT_EQ(symmetry_copies({}).size(), 0u);
    EXPECT_EQ(symmetry_copies({.mirror_x = true}).size(), 1u);
    EXPECT_EQ(symmetry_copies({.mirror_x = true, .mirror_y = true, .mirror_z = true}).size(), 7u);
    EXPECT_EQ(symmetry_copies({.radial = 5}).size(), 4u);
    // The dihedral group of the hexagon has twelve elements; with the plane across the axis, 24.
    EXPECT_EQ(symmetry_copies({.mirror_x = true, .radial = 6}).size(), 11u);
    EXPECT_EQ(symmetry_copies({.mirror_x = true, .mirror_z = true, .radial = 6}).size(), 23u);
    EXPECT_EQ(symmetry_copies({.mirror_x = true, .mirror_y = true, .radial = 4}).size(), 7u);
}

TEST(Symmetry, CopiesKeepDistancesAndTheHoldersAxisGoesAlong) {
    const Vec3 centre{0.01, 0.02, 0.03};
    for (const PoseMap& map : symmetry_copies({.mirror_x = true, .mirror_z = true, .radial = 3, .centre = centre})) {
        const brush::Pose copy = map.pose(kPose);
        EXPECT_NEAR(glm::distance(copy.position, centre), glm::distance(kPose.position, centre), 1e-15);
        EXPECT_NEAR(glm::distance(copy.axis(), map.linear * kPose.axis()), 0, 1e-14);
        EXPECT_NEAR(glm::length(copy.rotation), 1, 1e-15);
        EXPECT_EQ(copy.time, kPose.time);
    }
}

TEST(Symmetry, MirroringTwiceIsNothing) {
    const PoseMap map = symmetry_copies({.mirror_y = true})[0];
    const brush::Pose back = map.pose(map.pose(kPose));
    EXPECT_NEAR(glm::distance(back.position, kPose.position), 0, 1e-16);
    EXPECT_NEAR(std::abs(glm::dot(back.rotation, kPose.rotation)), 1, 1e-14);
}

// A ferrule that is rolled by r over a plane lies in the mirror as its image: the end of its broad side where the hair
// is long, +x, where that of the image is. Only y, in which every tuft is symmetric, points the other way.
TEST(Symmetry, TheBroadSideIsMirrored) {
    for (const double roll : {0.0, 0.4, -1.9}) {
        const auto turned = [](double r) { return Quat(std::cos(0.5 * r), 0, 0, std::sin(0.5 * r)); };
        const PoseMap mirror = symmetry_copies({.mirror_x = true})[0];
        const brush::Pose copy = mirror.pose({.position = {1, 2, 3}, .rotation = turned(roll)});
        const Vec3 x = mirror.linear * (turned(roll) * Vec3(1, 0, 0)),
                   y = mirror.linear * (turned(roll) * Vec3(0, 1, 0));
        EXPECT_NEAR(glm::distance(copy.rotation * Vec3(1, 0, 0), x), 0, 1e-15);
        EXPECT_NEAR(glm::distance(copy.rotation * Vec3(0, 1, 0), -y), 0, 1e-15);
    }
}

// A flat stroke's ferrule lies along (cos r, -sin r), right and down, with r of samples and settings together. Its
// image in a copy whose x is flipped is (-cos r, -sin r): to the sign for a flat, which has none, and with it for a
// sword.
TEST(Symmetry, AFlatStrokesRollIsMirrored) {
    const PoseMap mirror = symmetry_copies({.mirror_y = true})[0];
    for (const std::string brush : {"flat-12", "sword-8"}) {
        PaintStroke stroke;
        stroke.brush = brush;
        stroke.settings.roll = 0.3;
        stroke.trace.placement = {{0, -0.1, 0}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::project};
        stroke.trace.samples = {{.position = {0.01, 0.02, 0}, .pressure = 0.5, .roll = 0.4}};
        const PaintStroke copy = copy_of(JournalEntry(stroke), mirror, CopyReading::mirrored).get<PaintStroke>();
        const double r = 0.7, m = copy.trace.samples[0].roll + copy.settings.roll;
        const Vec2 image{-std::cos(r), -std::sin(r)}, found{std::cos(m), -std::sin(m)};
        const double along = glm::dot(image, found);
        EXPECT_NEAR(brush == "sword-8" ? along : std::abs(along), 1, 1e-12) << brush;
    }
}

TEST(Symmetry, TheTurnIsRoundTheAxis) {
    const auto copies = symmetry_copies({.radial = 4, .axis = {0, 0, 1}});
    const Vec3 p = copies[0].point({1, 0, 7});
    EXPECT_NEAR(glm::distance(p, Vec3(0, 1, 7)), 0, 1e-15);
}

}  // namespace
}  // namespace tuft::stroke
