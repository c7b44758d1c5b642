#include "app/work/unrolled.h"

#include <gtest/gtest.h>

#include <cmath>

/// Pictures of texts that run round a model.
namespace tuft::app {
namespace {

constexpr double kExact = 1e-12;  // metres, of sums and square roots of numbers below 1

TEST(Unrolled, InOnePlaneItIsAnIsometry) {
    const Vec3 x = glm::normalize(Vec3(1, 2, -1)), y = glm::normalize(glm::cross(Vec3(0.3, 1, 2), x));
    std::vector<stroke::Placement> placements;
    for (int i = 0; i < 5; ++i) {
        const double turn = 0.7 * i;
        placements.push_back({.origin = Vec3(1, 2, 3) + 0.01 * i * x + 0.003 * i * i * y,
                              .right = std::cos(turn) * x + std::sin(turn) * y,
                              .down = std::cos(turn) * y - std::sin(turn) * x});
    }
    const std::vector<PlaneFrame> frames = unrolled(placements);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_NEAR(frames[i].origin.x, 0.01 * i, kExact);
        EXPECT_NEAR(frames[i].origin.y, 0.003 * i * i, kExact);
        EXPECT_NEAR(frames[i].right.x, std::cos(0.7 * i), kExact);
        EXPECT_NEAR(frames[i].down.y, std::cos(0.7 * i), kExact);
    }
}

// Round a cone each character stands across the radius: unrolled, its origins are on a circle about the apex, as far
// from it as on the cone.
TEST(Unrolled, ALevelRowIsStraightRoundACylinderAndAnArcRoundACone) {
    constexpr double kRadius = 0.1;
    constexpr int kCount = 90;
    for (const double slope : {0.0, 0.5}) {  // radians between the axis and a straight line on the surface
        std::vector<stroke::Placement> placements;
        for (int i = 0; i < kCount; ++i) {
            const double a = 2 * M_PI * i / kCount;
            const Vec3 out(std::cos(a), std::sin(a), 0);
            placements.push_back({.origin = kRadius * out,
                                  .right = {-std::sin(a), std::cos(a), 0},
                                  .down = -std::sin(slope) * out - Vec3(0, 0, std::cos(slope))});
        }
        const std::vector<PlaneFrame> frames = unrolled(placements);
        const double chord = 2 * kRadius * std::sin(M_PI / kCount);
        for (std::size_t i = 1; i < frames.size(); ++i) {
            EXPECT_NEAR(glm::distance(frames[i].origin, frames[i - 1].origin), chord, kExact);
            const double turned = 2 * M_PI * static_cast<double>(i) / kCount * std::sin(slope);
            // The shortest arc between two neighbours is that of the cone but for their angle cubed, below 1e-4 each.
            EXPECT_NEAR(std::abs(std::atan2(frames[i].right.y, frames[i].right.x)),
                        std::abs(std::remainder(turned, 2 * M_PI)), 1e-4 * static_cast<double>(i));
        }
        if (slope == 0) {
            EXPECT_NEAR(frames.back().origin.x, (kCount - 1) * chord, 1e-10);
        }
    }
}

TEST(Unrolled, WhatIsOnTheFarSideHasADirection) {
    const std::vector<stroke::Placement> placements{{.origin = {0, -1, 0}, .right = {1, 0, 0}, .down = {0, 0, -1}},
                                                    {.origin = {0, 1, 0}, .right = {-1, 0, 0}, .down = {0, 0, -1}}};
    const PlaneFrame far = unrolled(placements).back();
    for (const double v : {far.origin.x, far.origin.y, far.right.x, far.down.y}) EXPECT_TRUE(std::isfinite(v));
    EXPECT_TRUE(unrolled({}).empty());
}

}  // namespace
}  // namespace tuft::app
