#include "contact/node_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "mesh/query/surface_query.h"
#include "shapes.h"

namespace tuft::contact {
namespace {

TEST(NodeContact, WallBetweenMeansBehindHoweverThin) {
    const mesh::TriangleMesh m = shapes::plate({0.05, 0.05, 0.0001});
    const mesh::SurfaceQuery surface(m);
    const NodeContactOptions options;
    for (const double depth : {0.0001, 0.001, 0.01, 0.03}) {
        const NodeContact s = find_node_contact(surface, {{0.013, 0.001, 0.0001 - depth}, {0.01, 0, 0.02}}, options);
        EXPECT_NEAR(s.plane.origin.z, 0.0001, 1e-9);
        EXPECT_NEAR(s.plane.normal.z, 1, 1e-9);
        EXPECT_NEAR(s.height, -depth, 1e-9);
        EXPECT_GT(s.outside.z, 0.0001);
    }
}

TEST(NodeContact, NormalTurnsSmoothlyOverAConvexEdge) {
    // Round the edge of a block at constant distance the normal is that of the rounded edge.
    const mesh::TriangleMesh m = shapes::plate({0.05, 0.05, 0.02}, 30);
    const mesh::SurfaceQuery surface(m);
    constexpr double r = 0.001;
    Vec3 before{0, 0, 1};
    for (int i = 0; i <= 90; ++i) {
        const double a = i * std::numbers::pi / 180;
        const Vec3 p{0.05 + r * std::sin(a), 0.003, 0.02 + r * std::cos(a)};
        const NodeContact s = find_node_contact(surface, {p, p + 0.001 * Vec3{std::sin(a), 0, std::cos(a)}}, {});
        EXPECT_LT(glm::length(s.plane.normal - before),
                  0.15);                     // 1° per step, and the blend's 26° over 16
        EXPECT_NEAR(s.height, r, 0.03 * r);  // 1 - cos of the angle at which the blend starts
        before = s.plane.normal;
    }
    EXPECT_NEAR(before.x, 1, 1e-6);
}

// Pressed through a ridge of 2.3°, on either side of the plane through it by what a float rounds. The node comes to the
// ridge from both; along the normals of the faces it came 2 depth sin 0.02 apart.
TEST(NodeContact, BelowAnEdgeOfASmoothSurfaceItIsTheSameFromEitherFace) {
    const mesh::TriangleMesh m = shapes::roof(0.02, 0.02, 20);
    const mesh::SurfaceQuery surface(m);
    for (const double depth : {1e-4, 1e-3, 3e-3}) {
        const auto below = [&](double x) {
            return find_node_contact(surface, {{x, 2e-4, -depth}, {x, 2e-4, 0.01}}, {});
        };
        const NodeContact left = below(-1e-9), right = below(1e-9);
        EXPECT_NEAR(glm::length(left.plane.origin - right.plane.origin), 0, 1e-8) << depth;
        EXPECT_NEAR(glm::length(left.plane.normal - right.plane.normal), 0, 1e-5) << depth;
        EXPECT_NEAR(left.height, -depth, 1e-8) << depth;
    }
}

// What is known of a surface bounds the search and leaves out what cannot be: no bit of a contact changes, on a block
// with sharp edges, on a smooth bowl and on a roof, from coarse triangles to some finer than the reach of an edge.
TEST(NodeContact, KnownContactsAndSmoothTrianglesChangeNoBit) {
    int with_edge = 0, without = 0;
    for (const mesh::TriangleMesh& m :
         {shapes::plate({0.01, 0.01, 0.004}, 6), shapes::bowl(0.02, 40), shapes::roof(0.4, 0.02, 40)}) {
        const mesh::SurfaceQuery surface(m);
        SmoothTriangles smooth;
        const NodeContactOptions plain, known{.smooth = &smooth};
        Random random(5);
        for (int i = 0; i < 400; ++i) {
            const Vec3 at = m.position(random.bits() % m.n_triangles(), static_cast<int>(random.bits() % 3));
            const auto near = [&](double far) {
                return at + far * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            };
            const NodeContact root = find_node_contact(surface, {near(2e-3), near(2e-3)}, plain);
            const Vec3 chain[] = {near(3e-3), near(2e-3), near(1e-3)};
            NodeContact before[3];
            const Vec3 feet[] = {m.position(0, 0), at, at};
            for (int k = 0; k < 3; ++k) before[k].triangle = 0, before[k].plane.origin = feet[k];
            const Recycled<NodeContact> a = find_chain_contacts(surface, root, chain, 0.01, plain),
                                        b = find_chain_contacts(surface, root, chain, 0.01, known,
                                                                {.contacts = before});
            for (std::size_t k = 0; k < a.size(); ++k) {
                ASSERT_EQ(a[k].triangle, b[k].triangle);
                ASSERT_EQ(a[k].plane.origin, b[k].plane.origin);
                ASSERT_EQ(a[k].plane.normal, b[k].plane.normal);
                ASSERT_EQ(a[k].wedge.beyond_origin, b[k].wedge.beyond_origin);
                ASSERT_EQ(a[k].wedge.beyond_normal, b[k].wedge.beyond_normal);
                ASSERT_EQ(a[k].outside, b[k].outside);
                ++(a[k].wedge.beyond_normal == Vec3{0} ? without : with_edge);
            }
        }
    }
    EXPECT_GT(with_edge, 300);
    EXPECT_GT(without, 300);
}

TEST(NodeContact, ANodeThatKeepsItsPlaneIsOffItByTwiceItsMoveAtMost) {
    const mesh::TriangleMesh m = shapes::bowl(0.02, 60);
    const mesh::SurfaceQuery surface(m);
    const NodeContact root = find_node_contact(surface, {{0, 0, -0.01}, {0, 0, -0.01}}, {});
    constexpr double kStill = 1e-5;
    Random random(3);
    int kept = 0;
    for (int i = 0; i < 200; ++i) {
        const double x = random.uniform(-0.008, 0.008), above = random.uniform(-1e-4, 1e-3);
        const Vec3 was[] = {{x, 0.001, above - std::sqrt(0.02 * 0.02 - x * x - 1e-6)}};
        const Vec3 now[] = {was[0] + random.uniform(0, 2 * kStill) * glm::normalize(Vec3{0.4, random.uniform(), -0.5})};
        const Recycled<NodeContact> before = find_chain_contacts(surface, root, was, 0.01, {}),
                                    fresh = find_chain_contacts(surface, root, now, 0.01, {}),
                                    held = find_chain_contacts(surface, root, now, 0.01, {}, {before, was, kStill});
        // Both the distance and the height over a plane change no faster than the node moves.
        EXPECT_NEAR(held[0].height, fresh[0].height, 2 * kStill);
        const bool still = glm::distance(was[0], now[0]) <= kStill;
        EXPECT_EQ(held[0].plane.origin, still ? before[0].plane.origin : fresh[0].plane.origin);
        kept += still;
    }
    EXPECT_GT(kept, 50);
    EXPECT_LT(kept, 150);
}

// A point that comes to an edge from outside is in front of it, though one of its two faces is seen from behind: its
// height is its distance. Between faces that stand 20 degrees apart directions lie up to 160 degrees off a normal.
TEST(NodeContact, BesideASharpEdgeAPointIsInFrontWhicheverFaceIsNearest) {
    constexpr double kSlope = 80 * std::numbers::pi / 180;
    const mesh::TriangleMesh m = shapes::roof(kSlope);
    const mesh::SurfaceQuery surface(m);
    for (const double distance : {1e-3, 0.02})
        for (int i = -19; i <= 19; ++i)
            for (const double y : {0.0, 0.0007, 0.0013}) {
                const double a = kSlope * i / 20;
                const Vec3 p = Vec3{0, y, 0} + distance * Vec3{std::sin(a), 0, std::cos(a)};
                const NodeContact s =
                    find_node_contact(surface, {p, p + 0.001 * Vec3{std::sin(a), 0, std::cos(a)}}, {});
                EXPECT_EQ(s.side, 1);
                // 1 - cos of the angle at which the blend from the face's own normal starts.
                EXPECT_NEAR(s.height, distance, 0.03 * distance) << "at " << a << ", y " << y;
            }
}

}  // namespace
}  // namespace tuft::contact
