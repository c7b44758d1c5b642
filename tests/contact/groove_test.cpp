#include "contact/groove.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "contact/contact.h"
#include "shapes.h"

namespace tuft::contact {
namespace {

constexpr double kHalf = 1.25e-3, kDeep = 2.5e-3;  // m, of a shut line as cars have them
constexpr double kSlope = 0.447;                   // of the walls, cosine

double floor_at(double x) {
    return std::abs(x) < kHalf ? kDeep * (std::abs(x) / kHalf - 1) : 0;
}

/// A groove along y with walls of 63° in a sheet in z = 0.
mesh::TriangleMesh groove() {
    return shapes::surface(4, 200, [](double u, double v) {
        constexpr double kPlaces[] = {-0.1, -kHalf, 0, kHalf, 0.1};
        const double x = kPlaces[std::lround(4 * u)];
        return Vec3{x, 0.1 * (v - 0.5), floor_at(x)};
    });
}

/// Of a point that comes to the surface from above the groove.
NodeContact contact_at(const mesh::SurfaceQuery& surface, const Vec3& p) {
    return find_node_contact(surface, {.node = p, .from = {0, p.y, 1e-3}}, {});
}

TEST(Groove, WallsFaceEachOtherAndFacesOfARidgeDoNot) {
    const mesh::TriangleMesh m = groove(), ridge = shapes::roof(1.1);
    const mesh::SurfaceQuery surface(m), over(ridge);
    const NodeContact left = contact_at(surface, {-2e-4, 0, -1e-3}), right = contact_at(surface, {2e-4, 0, -1e-3}),
                      bottom = contact_at(surface, {0, 0, -kDeep});
    EXPECT_TRUE(face_each_other(left, right));
    EXPECT_TRUE(face_each_other(right, left));
    EXPECT_TRUE(face_each_other(bottom, glm::dot(bottom.plane.normal, left.plane.normal) > 0.9 ? right : left));
    EXPECT_FALSE(face_each_other(left, left));
    EXPECT_FALSE(face_each_other(contact_at(over, {-1e-3, 0, -1e-3}), contact_at(over, {1e-3, 0, -1e-3})));
}

TEST(Groove, TheOtherWallIsFoundFromWhatTheNodeLayBetween) {
    const mesh::TriangleMesh m = groove();
    const mesh::SurfaceQuery surface(m);
    const NodeWalls known{contact_at(surface, {-2e-4, 0, -1e-3}), contact_at(surface, {2e-4, 0, -1e-3})};
    constexpr double kRadius = 5e-4;
    for (const double x : {-1e-4, 1e-4})
        for (const double z : {-1e-3, -2e-3, -kDeep - 3e-4}) {  // the last one behind both walls
            const Vec3 p{x, 1e-3, z};
            const NodeWalls walls = find_walls(surface, p, contact_at(surface, p), kRadius, known, {});
            ASSERT_TRUE(walls.in_groove()) << x << " " << z;
            // Whichever is nearer.
            EXPECT_GT(glm::dot(walls.own.plane.normal, known.own.plane.normal), 0.99) << x << " " << z;
            EXPECT_GT(glm::dot(walls.across.plane.normal, known.across.plane.normal), 0.99) << x << " " << z;
        }
    const Vec3 out{0.02, 0, 1e-4};
    EXPECT_FALSE(find_walls(surface, out, contact_at(surface, out), kRadius, known, {}).in_groove());
}

/// Of two spines in one groove, one on each wall: as one chain neither would be called nearer.
TEST(Groove, EachSpineLiesOnItsOwnWall) {
    const mesh::TriangleMesh m = groove();
    const mesh::SurfaceQuery surface(m);
    const NodeContact left = contact_at(surface, {-2e-4, 0, -1e-3}), right = contact_at(surface, {2e-4, 0, -1e-3});
    const NodeWalls between{left, right}, none{left, {}};
    const std::vector<Vec3> nodes{{-4e-4, 0, -1e-3}, {-4e-4, 2e-3, -1e-3}, {4e-4, 0, -1e-3}, {4e-4, 2e-3, -1e-3}};
    const std::vector<double> radii(nodes.size(), 1e-4);
    std::vector<NodeContact> nearest;
    for (const Vec3& p : nodes) nearest.push_back(contact_at(surface, p));
    const auto walls_of = [&](const std::vector<std::size_t>& lengths, const std::vector<NodeWalls>& known) {
        return find_chain_walls(surface, {lengths, nodes, nearest, radii, known}, {});
    };
    const auto is_on = [](const NodeWalls& walls, const NodeContact& wall) {
        return walls.in_groove() && glm::dot(walls.own.plane.normal, wall.plane.normal) > 0.99;
    };
    const std::vector<NodeWalls> all(nodes.size(), between);
    const Recycled<NodeWalls> two = walls_of({2, 2}, all), one = walls_of({4}, all);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        EXPECT_TRUE(is_on(two[i], i < 2 ? left : right)) << i;
        EXPECT_TRUE(is_on(one[i], left)) << i << ": the known one";
    }
    // The tip of one spine knows nothing of the root of the other.
    const Recycled<NodeWalls> first = walls_of({2, 2}, {between, between, none, none});
    EXPECT_TRUE(first[1].in_groove());
    EXPECT_FALSE(first[2].in_groove());
    const Recycled<NodeWalls> second = walls_of({2, 2}, {none, none, between, between});
    EXPECT_FALSE(second[1].in_groove());
    EXPECT_TRUE(second[2].in_groove());
    const std::vector<std::size_t> lengths{2, 2};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(is_root(lengths, i), i != 0 && i != 2) << i;
}

TEST(Groove, HairThatRocksInAGrooveStaysBeforeBothWallsAndPressesSteadily) {
    const mesh::TriangleMesh m = groove();
    const mesh::SurfaceQuery surface(m);
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("wolf-medium"));
    Memory memory;
    const auto move = [&](double z, double angle) {
        brush::Pose pose;
        pose.rotation = glm::angleAxis(angle, Vec3{1, 0, 0});
        pose.position = {2e-4, 0, tuft.preset.length + z};
        return step(tuft, pose, surface, memory, 1e-3);
    };
    constexpr int kDown = 200, kRock = 600;
    for (int i = 0; i <= kDown; ++i) move(1e-3 - 9e-3 * i / kDown, 0);
    double deepest = 0, jump = 0, mean = 0;
    int solves = 0;
    Vec3 force{0};
    for (int i = 0; i <= kRock; ++i) {
        const Result r = move(-8e-3, 0.25 * std::sin(2 * std::numbers::pi * i / kRock));
        const Vec3& tip = brush::predicted_nodes(tuft, tuft.pose).front();
        deepest = std::max(deepest, kSlope * (floor_at(tip.x) - tip.z));
        if (i > 0) jump = std::max(jump, glm::length(r.tuft.force - force));
        force = r.tuft.force;
        mean += glm::length(force) / (kRock + 1);
        solves += r.tuft.work.solves;
    }
    // The tip, of 0.08 mm, is indented by both walls; with the plane of one of them it goes 0.5 mm through the other.
    EXPECT_LT(deepest, 1.5e-4);
    // The hand turns by 2.6 mrad a sample at most, 0.1 mm at the mouth; with one plane the force jumps by all of it.
    EXPECT_LT(jump, 0.2 * mean);
    EXPECT_LT(solves, 1.2 * kRock);  // the walls of one sample hold in the next one
}

}  // namespace
}  // namespace tuft::contact
