#include "brush/rod/wedge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace tuft::brush {
namespace {

constexpr double kRound = 0.2;

/// An edge along y through the origin whose faces' normals lean by `half` to either side of +z.
Wedge edge(double half) {
    return {{Vec3{0}, Vec3{0}}, {{std::sin(half), 0, std::cos(half)}, {-std::sin(half), 0, std::cos(half)}}};
}

TEST(Wedge, IsThePlaneOverAFaceAndTheDistanceFromALineOverTheEdge) {
    const Wedge w = edge(0.25 * M_PI);
    const double c = std::sqrt(0.5);
    // Over the face at x > 0, 1 from the edge and 0.3 above.
    const Distance face = edge_distance(w, kRound, Vec3{c, 5, -c} + 0.3 * w.normal[0]);
    EXPECT_NEAR(face.z, 0.3, 1e-15);
    EXPECT_NEAR(glm::length(face.slope - w.normal[0]), 0, 1e-15);
    EXPECT_EQ(face.bend, 0);
    // Straight over the edge: from the line √2 ρ under it, less ρ.
    const Distance over = edge_distance(w, kRound, {0, -3, 0.5});
    EXPECT_NEAR(over.z, 0.5 + (std::sqrt(2.0) - 1) * kRound, 1e-15);
    EXPECT_NEAR(glm::length(over.slope - Vec3{0, 0, 1}), 0, 1e-15);
    EXPECT_NEAR(over.bend, 1 / (over.z + kRound), 1e-12);
}

TEST(Wedge, DoesNotCareWhichFaceComesFirst) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Wedge a = edge(random.uniform(0.2, 1.4));
        const Wedge b{{a.origin[1], a.origin[0]}, {a.normal[1], a.normal[0]}};
        const Vec3 x{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 1)};
        const Distance da = edge_distance(a, kRound, x), db = edge_distance(b, kRound, x);
        EXPECT_NEAR(da.z, db.z, 1e-14);
        EXPECT_NEAR(glm::length(da.slope - db.slope), 0, 1e-12);
    }
}

TEST(Wedge, SlopeTurnsNoFasterThanTheRoundingAllows) {
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const double half = random.uniform(0.2, 0.25 * M_PI);
        const Wedge w = edge(half);
        const Vec3 x{random.uniform(-0.5, 0.5), 0, random.uniform(-0.5, 0.5)};
        const Vec3 step = 1e-4 * glm::normalize(Vec3{random.uniform(-1, 1), 0, random.uniform(-1, 1)});
        const Distance a = edge_distance(w, kRound, x), b = edge_distance(w, kRound, x + step);
        // Deeper than the rounding the two faces meet in a ridge.
        if (a.z < -0.5 * kRound) continue;
        EXPECT_LE(glm::length(b.slope - a.slope), 1.01 * 1e-4 / (0.5 * kRound));
        // Central difference, h² times third derivatives.
        const double slope = (edge_distance(w, kRound, x + step).z - edge_distance(w, kRound, x - step).z) / 2;
        EXPECT_NEAR(slope, glm::dot(a.slope, step), 1e-4 * 1e-3);
    }
}

TEST(Wedge, TheHeightOverAnEdgeIsItsDistanceAndThatOfOneFaceUnlessItIsInFront) {
    Random random(12);
    for (int i = 0; i < 2000; ++i) {
        const Wedge w = edge(random.uniform(0.2, 1.5));
        const RoundedEdge e = round_edge(w, kRound);
        const Vec3 x{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const EdgeHeight height = edge_height(e, x);
        const Distance d = edge_distance(e, x);
        EXPECT_EQ(height.z, d.z);
        EXPECT_EQ(height.face<0, d.bend> 0);
        if (height.face >= 0) EXPECT_EQ(d.slope, w.normal[height.face]);
    }
}

TEST(Wedge, ALineOverAnEdgeHasTheDistancesOfItsPoints) {
    Random random(11);
    for (int i = 0; i < 2000; ++i) {
        const RoundedEdge e = round_edge(edge(random.uniform(0.2, 1.5)), kRound);
        const Vec3 x{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const Vec3 d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double s = random.uniform(-1, 1);
        const LineDistance on_line = LineOverEdge(e, x, d).at(s);
        const Distance at_point = edge_distance(e, x + s * d);
        // The same sums in another order, over sin² of the least angle, 0.02.
        EXPECT_NEAR(on_line.z, at_point.z, 1e-12);
        EXPECT_NEAR(on_line.slope, glm::dot(at_point.slope, d), 1e-11);
        const double across = glm::dot(at_point.across, d);
        EXPECT_NEAR(on_line.bend, at_point.bend * across * across, 1e-9 * (1 + at_point.bend));
    }
}

TEST(Wedge, NoEdgeLosesMoreThanARightAngledOne) {
    for (const double half : {0.3, 0.25 * M_PI, 1.0, 1.3, 1.5, 1.57}) {
        const double lost = edge_distance(edge(half), kRound, Vec3{0}).z;
        EXPECT_GE(lost, 0);
        EXPECT_LE(lost, (std::sqrt(2.0) - 1) * kRound + 1e-6);  // of 1 + cos in double
    }
}

TEST(Wedge, CornerKeepsOffBothPlanes) {
    const Wedge w{{Vec3{0}, Vec3{0}}, {{0.6, 0, 0.8}, {-0.6, 0, 0.8}}};
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x{random.uniform(-1, 1), 0, random.uniform(-1, 1)};
        const double least = std::min(glm::dot(x, w.normal[0]), glm::dot(x, w.normal[1]));
        const double z = corner_distance(w, kRound, x).z;
        EXPECT_LE(z, least + 1e-15);
        EXPECT_GE(z, least - 0.25 * kRound - 1e-15);
    }
}

}  // namespace
}  // namespace tuft::brush
