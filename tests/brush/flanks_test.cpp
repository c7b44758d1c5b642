#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "brush/tuft/tuft.h"

/// Walls beside a tuft that is drawn over a floor.
namespace tuft::brush {
namespace {

constexpr double kPress = 0.28;  // of the length
constexpr double kSpeed = 0.05;  // m/s, along x
constexpr double kLedge = 8e-3;  // m, height of the walls: over it the hand leads the thick part of the tuft along

/// Walls of the side nodes: those that the floor's y-axis meets at `left` and `right`; infinite:
/// none.
std::vector<ContactPlane> walls_beside(const Tuft& tuft, const Pose& pose, double left, double right) {
    const Recycled<Vec3> sides = predicted_sides(tuft, pose), nodes = predicted_nodes(tuft, pose);
    std::vector<ContactPlane> walls;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const bool to_left = sides[k].y > nodes[k / 2].y;
        const double y = to_left ? left : -right;
        if (std::isfinite(y) && sides[k].z < kLedge)
            walls.push_back({{0, y, 0}, {0, to_left ? -1.0 : 1.0, 0}});
        else
            walls.push_back({{0, 0, 0}, Vec3{0}});
    }
    return walls;
}

struct Drawn {
    Tuft tuft;
    TuftState state;
    std::vector<double> force_y, tip_y;  // of the last half second
    double work = 0, lost = 0;           // joules, of the hand and by the tuft
};

/// Pressed, drawn along x, and lifted if `lift`; walls at y = left and y = -right.
Drawn draw(const char* name, double left, double right, bool with_walls = true, bool lift = false) {
    Drawn out{.tuft = make_tuft(load_preset(name))};
    const double length = out.tuft.preset.length;
    const std::vector<ContactPlane> planes(out.tuft.trunk().rest.radius.size());
    Pose before;
    Vec3 force{0};
    const int steps = lift ? 1800 : 1400;
    for (int i = 0; i < steps; ++i) {
        const double t = i * 1e-3, down = std::min(1.0, t / 0.3) - std::clamp((t - 1.4) / 0.4, 0.0, 1.0);
        Pose pose{.position = {kSpeed * std::clamp(t - 0.3, 0.0, 1.1), 0, length * (1.02 - (kPress + 0.02) * down)},
                  .time = t};
        const auto walls = with_walls ? walls_beside(out.tuft, pose, left, right) : std::vector<ContactPlane>{};
        out.state = step(out.tuft, pose, planes, 1e-3, walls);
        if (i > 0) out.work -= glm::dot(0.5 * (force + out.state.force), pose.position - before.position);
        out.lost += out.state.energy.lost;
        force = out.state.force;
        before = pose;
        if (i >= 900 && i < 1400) {
            out.force_y.push_back(out.state.force.y);
            out.tip_y.push_back(predicted_nodes(out.tuft, pose).front().y);
        }
    }
    return out;
}

/// How far the tuft reaches towards +y under the ledge's height.
double reach(const TuftState& state) {
    double y = -1;
    for (const Section& s : state.branches.front().sections)
        if (s.centre.z < kLedge - 1e-3) y = std::max(y, s.centre.y + s.a * std::abs(s.e.y));
    return y;
}

/// Widest place of the spine's own line towards +y.
double spine_y(const Drawn& d) {
    double y = 0;
    for (const Vec3& x : predicted_nodes(d.tuft, d.tuft.pose)) y = std::min(y, x.y);
    return y;
}

constexpr double kNone = std::numeric_limits<double>::infinity();

TEST(Flanks, AWallPushesTheTuftAsideUntilItsFlankLiesOnIt) {
    for (const char* name : {"goat-medium", "mixed-medium", "wolf-medium"}) {
        SCOPED_TRACE(name);
        const Drawn free = draw(name, kNone, kNone);
        const double width = reach(free.state);
        double moved_before = 0, force_before = 0;
        for (const double part : {0.85, 0.7, 0.55}) {
            const double wall = part * width;
            const Drawn d = draw(name, wall, kNone);
            EXPECT_TRUE(d.state.converged);
            // A side node gives way by a hundredth of what it is pressed in; the last one under the
            // ledge's edge also bears the hair over it, on some two λ of 1.8 mm, four times its own
            // length at most.
            EXPECT_NEAR(reach(d.state), wall, 0.04 * (width - wall) + 2e-5);
            // Spread hair and the tuft's bend share the distance: each gives the more, the nearer the
            // wall.
            const double moved = -(spine_y(d) - spine_y(free));
            EXPECT_GT(moved, moved_before + 5e-5);
            EXPECT_LT(moved, width - wall);
            EXPECT_LT(d.state.force.y, force_before - 1e-4);
            force_before = d.state.force.y;
            moved_before = moved;
        }
    }
}

TEST(Flanks, AreNotMovedByWallsOnBothSides) {
    const Drawn d = draw("mixed-medium", 2.5e-3, 2.5e-3), free = draw("mixed-medium", kNone, kNone);
    EXPECT_LT(reach(d.state), 2.6e-3);
    // Round-off of a symmetric problem, through the solver's tolerance.
    EXPECT_NEAR(d.state.force.y, 0, 1e-4 * std::abs(d.state.force.z));
    EXPECT_NEAR(spine_y(d), spine_y(free), 1e-5);
}

TEST(Flanks, FeelNothingOfAWallOutOfReach) {
    const Drawn far = draw("mixed-medium", 0.012, 0.012), none = draw("mixed-medium", kNone, kNone, false);
    EXPECT_EQ(far.state.force, none.state.force);
    EXPECT_EQ(far.tuft.trunk().memory.node, none.tuft.trunk().memory.node);
    ASSERT_EQ(far.state.branches.front().sections.size(), none.state.branches.front().sections.size());
    for (std::size_t i = 0; i < none.state.branches.front().sections.size(); ++i)
        EXPECT_EQ(far.state.branches.front().sections[i].a, none.state.branches.front().sections[i].a);
}

TEST(Flanks, RestOnAWallInASteadyDrag) {
    const Drawn d = draw("mixed-medium", 2.5e-3, kNone);
    const auto [lo, hi] = std::minmax_element(d.force_y.begin() + 200, d.force_y.end());
    EXPECT_LT(*hi - *lo, 0.01 * std::abs(*lo));
    const auto [low, high] = std::minmax_element(d.tip_y.begin() + 200, d.tip_y.end());
    EXPECT_LT(*high - *low, 1e-5);
}

TEST(Flanks, TakeTheirEnergyFromTheHand) {
    // What the springs hold of a wall grows with the free half-width of the step before, at no
    // cost: within 3 % of the work of a whole press, drag and lift, 2 % of it as without walls.
    const Drawn d = draw("mixed-medium", 2.5e-3, kNone, true, true);
    EXPECT_NEAR(d.work, d.lost + d.state.energy.stored(), 0.03 * d.work);
    EXPECT_GT(d.work, 0);
}

}  // namespace
}  // namespace tuft::brush
