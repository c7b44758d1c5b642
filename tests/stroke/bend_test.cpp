#include "stroke/drawing/bend.h"

#include <gtest/gtest.h>

#include <cmath>

/// Drawings bent along a path: what a band of copies needs to meet.
namespace tuft::stroke {
namespace {

constexpr double kRound = 1e-12;  // of lengths of 0.1: rounding alone

TEST(Bend, IsTheIdentityWithoutCurvature) {
    for (const double curvature : {0.0, 1e-13, -1e-13}) {
        const Vec2 p = bend_point({0.03, -0.02}, curvature);
        EXPECT_NEAR(p.x, 0.03, kRound);
        EXPECT_NEAR(p.y, -0.02, kRound);
    }
}

TEST(Bend, MapsTheMiddleLineToAnArcOfItsLength) {
    for (const double curvature : {8.0, -3.0}) {
        const double radius = 1 / curvature;
        double length = 0;
        Vec2 before(0);
        for (int i = 1; i <= 1000; ++i) {
            const Vec2 p = bend_point({1e-4 * i, 0}, curvature);
            EXPECT_NEAR(glm::distance(p, Vec2(0, -radius)), std::abs(radius), kRound);
            length += glm::distance(before, p);
            before = p;
        }
        // Chords of an angle a are shorter than their arcs by a² / 24.
        EXPECT_NEAR(length, 0.1, 0.1 * 8e-4 * 8e-4 / 24 + kRound);
    }
}

TEST(Bend, NeighboursMeetAlongAWholeEdge) {
    constexpr double kWidth = 0.04;
    for (const double curvature : {12.0, 0.5, -7.0}) {
        // The next copy stands where the middle line is a width on, turned as it is there.
        const Vec2 at = bend_point({kWidth, 0}, curvature);
        const double c = std::cos(kWidth * curvature), s = std::sin(kWidth * curvature);
        for (const double y : {-0.015, 0.0, 0.01}) {
            const Vec2 right = bend_point({0.5 * kWidth, y}, curvature), p = bend_point({-0.5 * kWidth, y}, curvature);
            const Vec2 left = at + Vec2(c * p.x + s * p.y, c * p.y - s * p.x);
            EXPECT_NEAR(left.x, right.x, kRound);
            EXPECT_NEAR(left.y, right.y, kRound);
        }
    }
}

TEST(Bend, AreasStencilsAndOutlinesFollowTheArc) {
    constexpr double kCurvature = 10, kWidth = 0.06;
    const std::vector<Vec2> box{{-0.03, -0.01}, {0.03, -0.01}, {0.03, 0.01}, {-0.03, 0.01}};
    FlatArea area{.rings = {box}};
    area.under = {box};
    bend_area(area, kCurvature, kWidth);
    EXPECT_EQ(area.under, area.rings) << "what it reaches under goes the same way";
    double sum = 0;
    const std::vector<Vec2>& ring = area.rings[0];
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    // Of a ring sector: the mean radius is that of the middle line. Chords take 2/3 of the sagitta, 0.1 % of the width,
    // from the outer edge and give it at the inner one.
    EXPECT_NEAR(sum, 0.06 * 0.02, 1e-3 * kWidth * 0.06);
    EXPECT_LT(area.low.y, -0.01 + 1e-9);
    StrokeSamples trace{.stencil = {{box[0], box[1]}}, .outline = {box}};
    trace.samples.push_back({.position = {0.02, 0.005, 0}, .tilt = {0.1, 0}});
    bend_samples(trace, kCurvature, kWidth);
    EXPECT_EQ(trace.outline[0], ring);
    EXPECT_GT(trace.stencil.size(), 3u);
    EXPECT_EQ(trace.stencil.front().to, trace.stencil[1].from);
    EXPECT_NEAR(trace.samples[0].roll, 0.2, kRound);
    EXPECT_NEAR(trace.samples[0].tilt.x, 0.1 * std::cos(0.2), kRound) << "towards the path, which rises to the right";
    EXPECT_NEAR(trace.samples[0].tilt.y, -0.1 * std::sin(0.2), kRound);
}

TEST(Bend, EndsLapAndTheRestStays) {
    std::vector<std::vector<Vec2>> rings{{{-0.03, 0}, {0.03, -0.01}, {0.029, 0.01}}};
    lap_ends(rings, 0.03, 1e-4);
    EXPECT_NEAR(rings[0][0].x, -0.0301, kRound);
    EXPECT_NEAR(rings[0][1].x, 0.0301, kRound);
    EXPECT_EQ(rings[0][2].x, 0.029);
    EXPECT_EQ(rings[0][1].y, -0.01);
}

}  // namespace
}  // namespace tuft::stroke
