#include "app/hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/viewport.h"
#include "models.h"

namespace tuft::app {
namespace {

class HandOnSheet : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        mesh_ = new mesh::TriangleMesh(mesh::build_surface(io::read_model(TUFT_SOURCE "/models/sheet.ply")).mesh);
        query_ = new mesh::SurfaceQuery(*mesh_);
    }
    static void TearDownTestSuite() {
        delete query_;
        delete mesh_;
    }
    // A cursor straight above (x, y) of the sheet's middle.
    static Aim above(double x, double y, double time, double pressure = -1) {
        const Vec3 c = mesh_->bounds.centre();
        return {.ray = {c + Vec3(x, y, 0.5), {0, 0, -1}}, .view_up = {0, 1, 0}, .metres_per_pixel = 1e-4, .time = time, .pressure = pressure};
    }
    // Depth of the unbent tip at the last pose of a stroke along x at a steady speed (m/s).
    static double depth_at(double speed, HandSettings settings, double pressure = -1, double seconds = 0.6) {
        Hand hand(*query_, preset_, settings);
        brush::Pose last;
        for (int i = 0; i * 0.004 < seconds; ++i)
            for (const HandStep& step : hand.move(above(-0.05 + speed * 0.004 * i, 0, 0.004 * i, pressure)))
                if (!step.poses.empty()) last = step.poses.back();
        return preset_.length - (last.position.z - mesh_->bounds.hi.z);
    }
    static inline mesh::TriangleMesh* mesh_ = nullptr;
    static inline mesh::SurfaceQuery* query_ = nullptr;
    static inline const brush::Preset preset_ = brush::load_preset("wolf-medium");
};

TEST_F(HandOnSheet, AFastMousePressesLessThanASlowOne) {
    HandSettings s;
    s.dwell_effect = 0;
    const double slow = depth_at(0.005, s), fast = depth_at(0.15, s);
    EXPECT_GT(slow, fast * 1.2);
    EXPECT_GT(fast, 0);
    s.speed_effect = 0;
    // Without the effect both come to pressure · working depth; 0.6 s is 12 time constants.
    EXPECT_NEAR(depth_at(0.005, s), s.pressure * stroke::working_depth(preset_), 1e-6);
    EXPECT_NEAR(depth_at(0.15, s), s.pressure * stroke::working_depth(preset_), 1e-6);
}

TEST_F(HandOnSheet, ARestingMouseSinksIn) {
    HandSettings s;
    EXPECT_GT(depth_at(0, s, -1, 1.5), depth_at(0, s, -1, 0.3) + 1e-4);
}

TEST_F(HandOnSheet, APensPressureIsTheDepthWhateverItsSpeed) {
    HandSettings s;
    for (const double p : {0.2, 0.7})
        for (const double v : {0.005, 0.15}) EXPECT_NEAR(depth_at(v, s, p), p * stroke::working_depth(preset_), 1e-9);
    s.pen_gamma = 2;
    EXPECT_NEAR(depth_at(0.01, s, 0.5), 0.25 * stroke::working_depth(preset_), 1e-9);
}

// Drivers leave reports out in which nothing changed.
TEST_F(HandOnSheet, APenHeldStillWithoutReportsKeepsItsPressureUntilItsNextOne) {
    Hand hand(*query_, preset_, {});
    std::vector<brush::Pose> poses;
    const auto move = [&](double t, double pressure) {
        for (const HandStep& step : hand.move(above(0, 0, t, pressure))) poses.insert(poses.end(), step.poses.begin(), step.poses.end());
    };
    for (int i = 0; i <= 20; ++i) move(0.004 * i, 0.7);
    const std::size_t before = poses.size();
    move(1.08, 0);
    for (std::size_t i = before; i < poses.size(); ++i) {
        const double depth = preset_.length - (poses[i].position.z - mesh_->bounds.hi.z);
        // 20 time constants of the pressure had gone by: e^-20 · 0.7.
        if (poses[i].time < 1.08 - 0.011) {
            EXPECT_NEAR(depth / stroke::working_depth(preset_), 0.7, 2e-9) << poses[i].time;
        }
    }
    EXPECT_GT(poses.size(), before + 20);
    EXPECT_NEAR(poses.back().time, 1.08, 1e-9);
}

TEST_F(HandOnSheet, TheSamePathGivesTheSameStrokeForAnyRateOfSamples) {
    // The low-pass steps at 4 ms whatever the rate, so a path sampled at 4 ms and at 20 ms
    // ends within what the smoothing lags behind in one sample.
    HandSettings s;
    s.speed_effect = s.dwell_effect = 0;
    Vec3 end[2];
    for (int k = 0; k < 2; ++k) {
        Hand hand(*query_, preset_, s);
        const int n = k ? 30 : 150;
        for (int i = 0; i <= n; ++i) {
            const double t = 0.6 * i / n;
            for (const HandStep& step : hand.move(above(-0.03 + 0.1 * t, 0, t)))
                if (!step.poses.empty()) end[k] = step.poses.back().position;
        }
    }
    EXPECT_LT(glm::distance(end[0], end[1]), 1e-5);
}

TEST_F(HandOnSheet, OnAStringTheBrushStaysBehindByItsLength) {
    HandSettings s;
    s.string = 0.010;
    s.smoothing = 1e-4;
    Hand hand(*query_, preset_, s);
    Vec3 last(0);
    for (int i = 0; i <= 200; ++i)
        for (const HandStep& step : hand.move(above(-0.04 + 0.0004 * i, 0, 0.004 * i)))
            if (!step.poses.empty()) last = step.poses.back().position;
    EXPECT_NEAR(last.x, mesh_->bounds.centre().x + 0.04 - 0.010, 1e-4);
}

TEST_F(HandOnSheet, LeavingTheModelLiftsAndComingBackBegins) {
    HandSettings s;
    Hand hand(*query_, preset_, s);
    int begins = 0, ends = 0;
    double t = 0;
    for (const double x : {0.0, 0.001, 10.0, 11.0, 0.002, 0.003})
        for (const HandStep& step : hand.move(above(x, 0, t += 0.004))) {
            begins += step.kind == HandStep::Kind::begin;
            ends += step.kind == HandStep::Kind::end;
        }
    for (const HandStep& step : hand.lift()) ends += step.kind == HandStep::Kind::end;
    EXPECT_EQ(begins, 2);
    EXPECT_EQ(ends, 2);
    EXPECT_TRUE(hand.lift().empty());
}

TEST_F(HandOnSheet, LeanTurnsTheHolderAboutTheTip) {
    HandSettings s;
    s.tilt = {0.4, 0};
    const Hand hand(*query_, preset_, s);
    const auto pose = hand.hover(above(0, 0, 0));
    ASSERT_TRUE(pose);
    const Vec3 up = -pose->axis();
    EXPECT_NEAR(std::atan2(up.x, up.z), 0.4, 1e-9);
    EXPECT_NEAR(up.y, 0, 1e-9);
}

TEST_F(HandOnSheet, ATurnOfThePenTurnsTheTuftAboutItsHolder) {
    const Hand hand(*query_, preset_, {});
    Aim aim = above(0, 0, 0, 0.5);
    aim.tilt = Vec2(0.3, 0.1);
    const auto before = hand.hover(aim);
    aim.turn = 0.5;
    const auto after = hand.hover(aim);
    ASSERT_TRUE(before && after);
    EXPECT_LT(glm::distance(before->position, after->position), 1e-15);
    EXPECT_LT(glm::distance(before->axis(), after->axis()), 1e-12);
    // Seen along the holder, downwards, clockwise.
    const Vec3 from = before->rotation * Vec3(1, 0, 0), to = after->rotation * Vec3(1, 0, 0);
    EXPECT_NEAR(std::atan2(glm::dot(glm::cross(from, to), before->axis()), glm::dot(from, to)), 0.5, 1e-9);
}

TEST(Orbit, ZoomingKeepsThePlaceUnderTheCursor) {
    for (const bool parallel : {false, true}) {
        Orbit o;
        o.parallel = parallel;
        const Box scene{Vec3(-0.1), Vec3(0.1)};
        const render::GlCamera before = o.camera(800, 600, scene);
        // A point in the plane of the target keeps its place exactly.
        const Vec3 p = o.target + 0.03 * before.right - 0.02 * before.up;
        const Vec3 at = render::picture_point(before, p);
        o.zoom(3, p);
        const Vec3 now = render::picture_point(o.camera(800, 600, scene), p);
        EXPECT_NEAR(at.x, now.x, 1e-6);
        EXPECT_NEAR(at.y, now.y, 1e-6);
    }
}

TEST(Orbit, TheModelGoesWhereTheCapIsPushedAndTurned) {
    for (const double roll : {0.0, 0.7}) {
        Orbit before;
        before.roll = roll;
        const Box scene{Vec3(-0.1), Vec3(0.1)};
        const auto picture = [&](const Orbit& o, const Vec3& p) { return render::picture_point(o.camera(800, 600, scene), p); };
        const Vec3 middle = before.target, front = before.target - 0.05 * before.camera(800, 600, scene).forward;
        Orbit o = before;
        o.fly({0.1, 0, 0}, Vec3(0), true);
        // A tenth of a second across the shorter side, in the plane of the target.
        EXPECT_NEAR(picture(o, middle).x - picture(before, middle).x, 60, 1e-6);
        EXPECT_NEAR(picture(o, middle).y, picture(before, middle).y, 1e-6);
        o = before;
        o.fly({0, 0.1, 0}, Vec3(0), true);
        EXPECT_NEAR(picture(o, middle).y - picture(before, middle).y, -60, 1e-6);
        o = before;
        o.fly({0, 0, 0.1}, Vec3(0), true);
        EXPECT_NEAR(o.distance, before.distance * std::exp(-0.15), 1e-12);
        // About the upright its front goes to the right, about the level its front goes down.
        o = before;
        o.fly(Vec3(0), {0, 0.05, 0}, true);
        EXPECT_GT(picture(o, front).x, picture(before, front).x + 1);
        o = before;
        o.fly(Vec3(0), {0.05, 0, 0}, true);
        EXPECT_GT(picture(o, front).y, picture(before, front).y + 1);
        o = before;
        o.fly(Vec3(0), {0, 0, 0.05}, false);
        EXPECT_NEAR(o.roll - before.roll, 0.1, 1e-12);
        o.fly(Vec3(0), {0, 0, 0.05}, true);
        EXPECT_NEAR(o.roll - before.roll, 0.1, 1e-12);
    }
}

TEST(Orbit, RayAndPicturePointAreInverse) {
    for (const bool parallel : {false, true}) {
        Orbit o;
        o.parallel = parallel;
        o.roll = 0.3;
        const render::GlCamera c = o.camera(640, 480, Box{Vec3(-0.1), Vec3(0.1)});
        for (const Vec2 at : {Vec2(10, 20), Vec2(320, 240), Vec2(600, 33)}) {
            const render::GlRay ray = render::ray_at(c, at.x, at.y);
            const Vec3 back = render::picture_point(c, ray.origin + 0.37 * ray.direction);
            EXPECT_NEAR(back.x, at.x, 1e-7);
            EXPECT_NEAR(back.y, at.y, 1e-7);
        }
    }
}

}  // namespace
}  // namespace tuft::app
