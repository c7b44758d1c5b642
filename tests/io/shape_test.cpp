#include "io/strokes/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/segment.h"

namespace tuft::io {
namespace {

using std::numbers::pi;

Ring regular(double r, int n, double jag = 0) {
    Ring ring;
    for (int i = 0; i < n; ++i)
        ring.push_back((r + (i % 2 ? jag : -jag)) * Vec2(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)));
    return ring;
}
Ring box(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

// Metres that places are rounded by: 2⁻³⁰ of an extent of 4 at most.
constexpr double kRounded = 4e-9;

TEST(Shape, RulesSayWhatIsInside) {
    // Two squares of 2 × 2 that share one of 1 × 1, both counter-clockwise.
    const std::vector<Ring> rings{box(0, 0, 2, 2), box(1, 1, 3, 3)};
    const Shape all(rings, FillRule::nonzero), odd(rings, FillRule::even_odd);
    EXPECT_NEAR(all.area(), 7, 12 * kRounded);
    EXPECT_NEAR(all.perimeter(), 12, 12 * kRounded);
    EXPECT_NEAR(odd.area(), 6, 12 * kRounded);
    EXPECT_TRUE(all.contains({1.5, 1.5}));
    EXPECT_FALSE(odd.contains({1.5, 1.5}));
    for (const Shape* s : {&all, &odd}) {
        EXPECT_TRUE(s->contains({0.5, 0.5}));
        EXPECT_FALSE(s->contains({2.5, 0.5}));
    }
    // A bow tie crosses itself: two triangles of area 1 each.
    const Shape tie(std::vector<Ring>{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}, FillRule::nonzero);
    EXPECT_EQ(tie.rings().size(), 2u);
    EXPECT_NEAR(tie.area(), 2, 12 * kRounded);
}

TEST(Shape, TheAreaIsOnTheLeft) {
    std::vector<Ring> rings{box(0, 0, 4, 4), box(1, 1, 3, 3)};
    for (int turned = 0; turned < 2; ++turned) {
        const Shape frame(rings, FillRule::even_odd);
        ASSERT_EQ(frame.rings().size(), 2u);
        for (const Ring& ring : frame.rings())
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2 a = ring[i], edge = ring[(i + 1) % ring.size()] - a, left(-edge.y, edge.x);
                EXPECT_TRUE(frame.contains(a + 0.5 * edge + 0.01 * left));
                EXPECT_FALSE(frame.contains(a + 0.5 * edge - 0.01 * left));
            }
        std::reverse(rings[turned].begin(), rings[turned].end());
    }
}

TEST(Shape, AnInsetLiesAtItsDistance) {
    // Of a square a square; of the inner edge of a frame one with round corners.
    const Shape square(std::vector<Ring>{box(0, 0, 4, 4)}, FillRule::nonzero);
    EXPECT_NEAR(square.inset(1, 1e-3).area(), 4, 16 * kRounded);
    EXPECT_TRUE(square.inset(2.001, 1e-3).empty());
    const Shape frame(std::vector<Ring>{box(0, 0, 4, 4), box(1, 1, 3, 3)}, FillRule::even_odd);
    const Shape inner = frame.inset(0.25, 1e-3);
    // Chords of the four quarter circles may cut 0.001 off them.
    EXPECT_NEAR(inner.area(), 3.5 * 3.5 - (4 + 4 * 2 * 0.25 + pi * 0.25 * 0.25), 2 * pi * 0.25 * 1e-3);
    for (const Ring& ring : inner.rings())
        for (const Vec2& p : ring) {
            double nearest = 1e9;
            for (const Ring& edge : frame.rings())
                for (std::size_t i = 0; i < edge.size(); ++i)
                    nearest = std::min(nearest, segment_distance(edge[i], edge[(i + 1) % edge.size()], p));
            EXPECT_NEAR(nearest, 0.25, 1e-3);
        }
}

TEST(Shape, ASimplifiedOutlineStaysWithinItsTolerance) {
    const Shape jagged(std::vector<Ring>{regular(1, 2000, 0.004)}, FillRule::nonzero);
    const double tolerance = 0.01;
    const Shape few = jagged.simplified(tolerance);
    ASSERT_EQ(few.rings().size(), 1u);
    // A chord that leaves a circle by s spans 2 √(2 s); those of 0.01 to 0.01 + 0.008 at most.
    EXPECT_LT(few.rings()[0].size(), static_cast<std::size_t>(4 * 2 * pi / (2 * std::sqrt(2 * tolerance))));
    for (const Vec2& p : jagged.rings()[0]) {
        double nearest = 1e9;
        const Ring& ring = few.rings()[0];
        for (std::size_t i = 0; i < ring.size(); ++i)
            nearest = std::min(nearest, segment_distance(ring[i], ring[(i + 1) % ring.size()], p));
        EXPECT_LE(nearest, tolerance + kRounded);
    }
    const Shape square(std::vector<Ring>{box(0, 0, 1, 1)}, FillRule::nonzero);
    EXPECT_EQ(square.simplified(0.1).rings()[0].size(), 4u);
    EXPECT_TRUE(square.simplified(2).empty());
}

TEST(Shape, IsTheSameInEverySize) {
    const std::vector<Ring> ring{regular(0.37, 77, 0.02)};
    std::vector<Ring> large = ring;
    for (Vec2& p : large[0]) p *= 1024.0;
    const Shape a = Shape(ring, FillRule::nonzero).inset(0.05, 1e-3),
                b = Shape(large, FillRule::nonzero).inset(1024 * 0.05, 1.024);
    ASSERT_EQ(a.rings().size(), b.rings().size());
    for (std::size_t i = 0; i < a.rings().size(); ++i) {
        ASSERT_EQ(a.rings()[i].size(), b.rings()[i].size());
        for (std::size_t k = 0; k < a.rings()[i].size(); ++k) EXPECT_EQ(1024.0 * a.rings()[i][k], b.rings()[i][k]);
    }
}

// As a hostile file may have it.
TEST(Shape, WhatIsTooMuchIsNothing) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(0, 1);
    Ring tangle;
    for (int i = 0; i < 15'000; ++i) tangle.push_back({place(random), place(random)});
    EXPECT_TRUE(Shape(std::vector<Ring>{tangle}, FillRule::nonzero).empty()) << "10^7 crossings";
    EXPECT_TRUE(Shape(std::vector<Ring>{regular(1, 20'001)}, FillRule::nonzero).empty());
    EXPECT_FALSE(Shape(std::vector<Ring>{regular(1, 20'000)}, FillRule::nonzero).empty());
    for (const double bad : {HUGE_VAL, -HUGE_VAL, std::nan("")})
        EXPECT_TRUE(Shape(std::vector<Ring>{{{0, 0}, {1, 0}, {bad, 1}}}, FillRule::nonzero).empty());
    for (const double size : {1e-320, 1e-200, 1e200, 1e308}) {
        const Shape s(std::vector<Ring>{box(0, 0, size, size)}, FillRule::nonzero);
        EXPECT_TRUE(s.empty() || s.contains({0.5 * size, 0.5 * size})) << size;
    }
    EXPECT_TRUE(Shape(std::vector<Ring>{}, FillRule::nonzero).empty());
    EXPECT_TRUE(Shape(std::vector<Ring>{{}, {{1, 1}}, {{1, 1}, {2, 2}}}, FillRule::nonzero).empty());
}

}  // namespace
}  // namespace tuft::io
