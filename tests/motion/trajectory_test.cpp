#include "motion/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../atlas/shapes.h"
#include "core/error.h"

namespace tuft::motion {
namespace {

/// The ferrule over a point of a surface with this outward normal.
brush::Pose over(const Vec3& point, const Vec3& normal, double height, double time = 0) {
    const Frame frame = make_frame(Vec3(0), normal);
    return {point + height * normal, glm::quat_cast(Mat3(frame.t, frame.b, frame.n)), time};
}

/// A wavy stroke round a cylinder of radius 50 mm, 20 mm above it, `count` samples in `seconds`.
StrokePath wave(double from, double to, int count, double seconds) {
    StrokePath stroke{.id = 7, .label = "wave", .points = {}, .tuft_length = 0.03, .tuft_radius = 0.003};
    for (int i = 0; i < count; ++i) {
        const double t = static_cast<double>(i) / (count - 1), a = from + (to - from) * t;
        const Vec3 normal(std::cos(a), std::sin(a), 0);
        stroke.points.push_back(
            {over(0.05 * normal + Vec3(0, 0, 0.1 + 0.02 * std::sin(20 * t)), normal, 0.02, seconds * t)});
    }
    return stroke;
}

struct Most {
    double speed = 0, acceleration = 0, turn = 0;
};

/// Finite differences of one move, at rest before and after it.
Most differences(const std::vector<Waypoint>& points) {
    Most most;
    Vec3 before(0);
    double before_time = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3 velocity(0);
        double time = 0;
        if (i + 1 < points.size()) {
            time = points[i + 1].pose.time - points[i].pose.time;
            EXPECT_GT(time, 0);
            velocity = (points[i + 1].pose.position - points[i].pose.position) / time;
            most.speed = std::max(most.speed, glm::length(velocity));
            most.turn = std::max(most.turn, angle_between(points[i].pose.rotation, points[i + 1].pose.rotation) / time);
        }
        most.acceleration = std::max(most.acceleration, glm::length(velocity - before) / (0.5 * (time + before_time)));
        before = velocity;
        before_time = time;
    }
    return most;
}

// A plotter cannot lean its brush: the tip stays, the axis is vertical, and about it the holder turns as it did.
TEST(Upright, KeepsTheTipAndTheTurnOfTheHolder) {
    StrokePath stroke{.id = 1, .label = "line", .points = {}, .tuft_length = 0.03, .tuft_radius = 0.003};
    std::vector<Vec3> tips;
    for (int i = 0; i < 20; ++i) {
        const double lean = 0.15 * std::cos(0.3 * i), towards = 0.7 * i, turn = 0.2 * i;
        const Quat rotation =
            glm::angleAxis(lean, Vec3(std::cos(towards), std::sin(towards), 0)) * glm::angleAxis(turn, Vec3(0, 0, 1));
        stroke.points.push_back({{Vec3(1e-3 * i, 2e-3 * i, 0.025), rotation, 0.1 * i}});
        tips.push_back(stroke.points.back().pose.position + 0.03 * stroke.points.back().pose.axis());
    }
    EXPECT_NEAR(make_upright(stroke), 0.15, 1e-12);
    for (std::size_t i = 0; i < tips.size(); ++i) {
        const brush::Pose& pose = stroke.points[i].pose;
        EXPECT_LT(glm::length(pose.position + 0.03 * pose.axis() - tips[i]), 1e-15);
        EXPECT_LT(angle_between(pose.rotation, glm::angleAxis(0.2 * static_cast<double>(i), Vec3(0, 0, 1))), 1e-7);
    }
    StrokePath slanted = stroke;
    slanted.points[3].pose.rotation = glm::angleAxis(0.3, Vec3(1, 0, 0));
    EXPECT_NEAR(make_upright(slanted), 0.3, 1e-12);
    EXPECT_EQ(slanted.points[3].pose.rotation, glm::angleAxis(0.3, Vec3(1, 0, 0)));
}

TEST(Retime, KeepsTheLimitsByFiniteDifferences) {
    for (const Limits limits : {Limits{}, Limits{0.02, 0.1, 0.5}, Limits{1, 20, 10}}) {
        std::vector<Waypoint> points = wave(0, 2, 150, 0.5).points;
        const std::vector<Waypoint> path = points;
        retime(points, limits);
        const Most most = differences(points);
        EXPECT_LE(most.speed, limits.speed);
        EXPECT_LE(most.acceleration, limits.acceleration);
        EXPECT_LE(most.turn, limits.turn);
        for (std::size_t i = 0; i < path.size(); ++i) {
            EXPECT_EQ(points[i].pose.position, path[i].pose.position);
            EXPECT_EQ(points[i].pose.rotation, path[i].pose.rotation);
        }
    }
}

TEST(Retime, IsNeverFasterThanTheHand) {
    std::vector<Waypoint> points = wave(0, 1, 80, 60).points;
    const std::vector<double> pace(points.size() - 1, 60.0 / 79);
    retime(points, {}, pace);
    EXPECT_GE(points.back().pose.time, 60 - 1e-9);
    EXPECT_LT(points.back().pose.time, 66);  // and not much slower: starting and stopping
}

// A straight path of length d from rest to rest with half of the acceleration a for speed takes 2 √(d / ½a) where the
// speed limit is never met; steps make it slower by a few percent.
TEST(Retime, ReachesWhatTheAccelerationAllows) {
    std::vector<Waypoint> points;
    for (int i = 0; i <= 400; ++i) points.push_back({over({0.1 * i / 400, 0, 0}, {0, 0, 1}, 0.02)});
    retime(points, {.speed = 10, .acceleration = 1, .turn = 1});
    const double least = 2 * std::sqrt(0.1 / 0.5);
    EXPECT_GE(points.back().pose.time, 0.99 * least);
    EXPECT_LT(points.back().pose.time, 1.1 * least);
}

TEST(Plan, MovesFollowEachOtherAndKeepTheLimits) {
    const mesh::TriangleMesh model = test::cylinder();
    const mesh::SurfaceQuery query(model);
    const MotionOptions options;
    const Trajectory t = plan(query, {wave(0, 1, 60, 2), wave(3, 3.6, 60, 2)}, options);
    ASSERT_EQ(t.moves.size(), 7u);
    EXPECT_EQ(t.moves[3].kind, MoveKind::travel);
    for (std::size_t i = 0; i < t.moves.size(); ++i) {
        const Most most = differences(t.moves[i].points);
        EXPECT_LE(most.speed, options.limits.speed) << i;
        EXPECT_LE(most.acceleration, options.limits.acceleration) << i;
        if (i == 0) continue;
        const brush::Pose &a = t.moves[i - 1].points.back().pose, &b = t.moves[i].points.front().pose;
        EXPECT_LT(glm::length(a.position - b.position), 1e-12);
        EXPECT_NEAR(a.time, b.time, 1e-12);
        EXPECT_LT(angle_between(a.rotation, b.rotation), 1e-6);
    }
    EXPECT_GT(t.seconds(), 4);
}

/// A pose of a polyline at a time of the hand.
brush::Pose at(const std::vector<Waypoint>& points, double time) {
    std::size_t i = 1;
    while (i + 1 < points.size() && *points[i].hand_time < time) ++i;
    const double start = *points[i - 1].hand_time, t = (time - start) / (*points[i].hand_time - start);
    const brush::Pose &a = points[i - 1].pose, &b = points[i].pose;
    return {glm::mix(a.position, b.position, t), glm::slerp(a.rotation, b.rotation, t), time};
}

// A holder that leans back and forth while it goes straight on at an uneven pace. At the hand's times, the mouth stays
// within 5 µm and what it covers in 1 ms, the tip within twice 5 µm and that: its own and the mouth's.
TEST(Plan, PointsThatAreLeftOutMoveNeitherMouthNorTip) {
    const mesh::TriangleMesh model = test::cylinder();
    StrokePath stroke = wave(0, 0.001, 400, 2);
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
        const double t = static_cast<double>(i) / 399;
        brush::Pose& pose = stroke.points[i].pose;
        pose.position.z = 0.1 + 0.02 * (t + 0.1 * std::sin(6 * t));
        pose.rotation = glm::angleAxis(0.2 * std::sin(9 * t), Vec3(0, 0, 1)) * pose.rotation;
    }
    const Trajectory t = plan(mesh::SurfaceQuery(model), {stroke}, {});
    const std::vector<Waypoint>& kept = t.moves[1].points;
    EXPECT_LT(kept.size(), stroke.points.size());
    EXPECT_EQ(*kept.front().hand_time, 0);
    EXPECT_EQ(*kept.back().hand_time, 2);
    const double covered = 0.017 * 1e-3;  // metres, at the greatest speed
    for (const Waypoint& p : stroke.points) {
        const brush::Pose &own = p.pose, now = at(kept, own.time);
        EXPECT_LT(glm::length(now.position - own.position), 5e-6 + covered);
        const Vec3 off =
            now.position + stroke.tuft_length * now.axis() - own.position - stroke.tuft_length * own.axis();
        EXPECT_LT(glm::length(off), 2 * 5e-6 + 2 * covered);
    }
}

// From one side of a closed cylinder to the other: rays along every step of tip, mouth and holder meet nothing.
TEST(Plan, TravelIsClearOfTheModel) {
    const mesh::TriangleMesh model = test::cylinder();
    const mesh::SurfaceQuery query(model);
    for (const double turn : {0.3, 1.5, 2.6, 3.14159}) {
        const std::vector<StrokePath> strokes{wave(0, 0.2, 20, 1), wave(turn, turn + 0.2, 20, 1)};
        for (const Move& move : plan(query, strokes, {}).moves) {
            if (move.kind != MoveKind::travel) continue;
            for (std::size_t i = 0; i + 1 < move.points.size(); ++i)
                for (const double s : {-strokes[0].tuft_length, 0.0, 0.05, 0.15}) {
                    const auto at = [&](std::size_t k) {
                        return move.points[k].pose.position - s * move.points[k].pose.axis();
                    };
                    const Vec3 d = at(i + 1) - at(i);
                    const double length = glm::length(d);
                    if (length > 0) {
                        EXPECT_FALSE(query.occluded(at(i), d / length, 0, length)) << turn << " " << s;
                    }
                    EXPECT_FALSE(query.closest_point(at(i), 0.9 * kTravelGap)) << turn << " " << s;
                }
        }
    }
}

// Inside a torus' hole a long holder that leans over hits the other side.
TEST(Plan, RefusesWhereTheHolderWouldHit) {
    const mesh::TriangleMesh model = test::torus();
    const mesh::SurfaceQuery query(model);
    StrokePath stroke{.id = 12, .label = "inside", .points = {}, .tuft_length = 0.02, .tuft_radius = 0.003};
    for (int i = 0; i < 10; ++i) {
        const double a = 0.02 * i;
        const Vec3 out(std::cos(a), std::sin(a), 0);
        stroke.points.push_back({over(0.03 * out, -out, 0.012, 0.1 * i)});
    }
    try {
        plan(query, {stroke}, {});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("stroke 12 'inside': the holder would hit the model at"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_EQ(plan(query, {stroke}, {.holder = {0.004, 0.012}, .clearance = 0.005}).moves.size(), 3u);
}

}  // namespace
}  // namespace tuft::motion
