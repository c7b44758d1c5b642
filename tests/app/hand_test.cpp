#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/input/pointer.h"
#include "app/tools/tip_lag_cache.h"
#include "app/view/viewport.h"
#include "models.h"
#include "paths.h"

namespace tuft::app {
namespace {

class PointerOnSheet : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        mesh_ = new mesh::TriangleMesh(mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh);
        query_ = new mesh::SurfaceQuery(*mesh_);
    }
    static void TearDownTestSuite() {
        delete query_;
        delete mesh_;
    }
    // A cursor straight above (x, y) of the sheet's middle.
    static Aim above(double x, double y, double time, double pressure = -1) {
        const Vec3 c = mesh_->bounds.centre();
        return {.ray = {c + Vec3(x, y, 0.5), {0, 0, -1}},
                .view_up = {0, 1, 0},
                .metres_per_pixel = 1e-4,
                .time = time,
                .pressure = pressure};
    }
    // Depth of the unbent tip at the last pose of a stroke along x at a steady speed (m/s).
    static double depth_at(double speed, PointerSettings settings, double pressure = -1, double seconds = 0.6) {
        PointerInput hand(*query_, preset_, settings);
        brush::Pose last;
        for (int i = 0; i * 0.004 < seconds; ++i)
            for (const StrokeStep& step : hand.move(above(-0.05 + speed * 0.004 * i, 0, 0.004 * i, pressure)))
                if (!step.poses.empty()) last = step.poses.back();
        return preset_.length - (last.position.z - mesh_->bounds.hi.z);
    }
    static inline mesh::TriangleMesh* mesh_ = nullptr;
    static inline mesh::SurfaceQuery* query_ = nullptr;
    static inline const brush::Preset preset_ = brush::load_preset("wolf-medium");
};

TEST_F(PointerOnSheet, AFastMousePressesLessThanASlowOne) {
    PointerSettings s;
    s.dwell_effect = 0;
    const double slow = depth_at(0.005, s), fast = depth_at(0.15, s);
    EXPECT_GT(slow, fast * 1.2);
    EXPECT_GT(fast, 0);
    s.speed_effect = 0;
    s.clean_ends = false;  // which tips the holder ahead over the first millimetres
    // Without the effect both come to pressure · working depth; 0.6 s is 12 time constants.
    EXPECT_NEAR(depth_at(0.005, s), s.pressure * stroke::working_depth(preset_), 1e-6);
    EXPECT_NEAR(depth_at(0.15, s), s.pressure * stroke::working_depth(preset_), 1e-6);
}

TEST_F(PointerOnSheet, ARestingMouseSinksIn) {
    PointerSettings s;
    EXPECT_GT(depth_at(0, s, -1, 1.5), depth_at(0, s, -1, 0.3) + 1e-4);
}

TEST_F(PointerOnSheet, APensPressureIsTheDepthWhateverItsSpeed) {
    PointerSettings s;
    for (const double p : {0.2, 0.7})
        for (const double v : {0.005, 0.15}) EXPECT_NEAR(depth_at(v, s, p), p * stroke::working_depth(preset_), 1e-9);
    s.pen_gamma = 2;
    EXPECT_NEAR(depth_at(0.01, s, 0.5), 0.25 * stroke::working_depth(preset_), 1e-9);
}

// Drivers leave reports out in which nothing changed.
TEST_F(PointerOnSheet, APenHeldStillWithoutReportsKeepsItsPressureUntilItsNextOne) {
    PointerInput hand(*query_, preset_, {});
    std::vector<brush::Pose> poses;
    const auto move = [&](double t, double pressure) {
        for (const StrokeStep& step : hand.move(above(0, 0, t, pressure)))
            poses.insert(poses.end(), step.poses.begin(), step.poses.end());
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

TEST_F(PointerOnSheet, TheSamePathGivesTheSameStrokeForAnyRateOfSamples) {
    // The low-pass steps at 4 ms whatever the rate, so a path sampled at 4 ms and at 20 ms
    // ends within what the smoothing lags behind in one sample.
    PointerSettings s;
    s.speed_effect = s.dwell_effect = 0;
    Vec3 end[2];
    for (int k = 0; k < 2; ++k) {
        PointerInput hand(*query_, preset_, s);
        const int n = k ? 30 : 150;
        for (int i = 0; i <= n; ++i) {
            const double t = 0.6 * i / n;
            for (const StrokeStep& step : hand.move(above(-0.03 + 0.1 * t, 0, t)))
                if (!step.poses.empty()) end[k] = step.poses.back().position;
        }
    }
    EXPECT_LT(glm::distance(end[0], end[1]), 1e-5);
}

TEST_F(PointerOnSheet, OnAStringTheBrushStaysBehindByItsLength) {
    PointerSettings s;
    s.string = 0.010;
    s.smoothing = 1e-4;
    PointerInput hand(*query_, preset_, s);
    Vec3 last(0);
    for (int i = 0; i <= 200; ++i)
        for (const StrokeStep& step : hand.move(above(-0.04 + 0.0004 * i, 0, 0.004 * i)))
            if (!step.poses.empty()) last = step.poses.back().position;
    EXPECT_NEAR(last.x, mesh_->bounds.centre().x + 0.04 - 0.010, 1e-4);
}

// The pressure of the pen stays at its place: half way along the string the brush is pressed as the pen was there.
TEST_F(PointerOnSheet, OnAStringAPensStrokeEndsWhereThePenLeaves) {
    PointerSettings s;
    s.string = 0.010;
    s.smoothing = 1e-4;
    PointerInput hand(*query_, preset_, s);
    std::vector<brush::Pose> poses;
    const auto take = [&](const std::vector<StrokeStep>& steps) {
        for (const StrokeStep& step : steps) poses.insert(poses.end(), step.poses.begin(), step.poses.end());
    };
    for (int i = 0; i <= 200; ++i) take(hand.move(above(-0.04 + 0.0004 * i, 0, 0.004 * i, 0.2 + 0.002 * i)));
    take(hand.lift());
    const double middle = mesh_->bounds.centre().x;
    EXPECT_NEAR(poses.back().position.x, middle + 0.04, 1e-4);
    const auto at = std::ranges::find_if(poses, [&](const brush::Pose& p) { return p.position.x > middle + 0.035; });
    ASSERT_NE(at, poses.end());
    const double depth = preset_.length - (at->position.z - mesh_->bounds.hi.z);
    // Pressure 0.575 at 35 mm. The tip comes there at 0.1 m/s, and the brush follows in 4 ms: 0.4 mm, or 0.002.
    EXPECT_NEAR(depth / stroke::working_depth(preset_), 0.575, 0.004);
}

// A dot: the pen lands lightly, slips a little, presses, and leaves.
TEST_F(PointerOnSheet, OnAStringAPenThatRestsPressesAsItPresses) {
    PointerSettings s;
    s.string = 0.010;
    PointerInput hand(*query_, preset_, s);
    double deepest = 0;
    for (int i = 0; i <= 100; ++i) {
        const double pressure = i < 100 ? std::min(0.8, 0.05 + 0.015 * i) : 0.02;
        for (const StrokeStep& step : hand.move(above(std::min(2e-4, 1e-4 * i), 0, 0.004 * i, pressure)))
            for (const brush::Pose& p : step.poses)
                deepest = std::max(deepest, preset_.length - (p.position.z - mesh_->bounds.hi.z));
    }
    // It follows the pen in a few milliseconds, and the pen presses so for 0.2 s.
    EXPECT_NEAR(deepest / stroke::working_depth(preset_), 0.8, 1e-3);
}

TEST_F(PointerOnSheet, LeavingTheModelLiftsAndComingBackBegins) {
    PointerSettings s;
    PointerInput hand(*query_, preset_, s);
    int begins = 0, ends = 0;
    double t = 0;
    for (const double x : {0.0, 0.001, 10.0, 11.0, 0.002, 0.003})
        for (const StrokeStep& step : hand.move(above(x, 0, t += 0.004))) {
            begins += step.kind == StrokeStep::Kind::begin;
            ends += step.kind == StrokeStep::Kind::end;
        }
    for (const StrokeStep& step : hand.lift()) ends += step.kind == StrokeStep::Kind::end;
    EXPECT_EQ(begins, 2);
    EXPECT_EQ(ends, 2);
    EXPECT_TRUE(hand.lift().empty());
}

// Two slabs 10 mm thick, that far apart; `floor`: metres down to what lies below, 0: nothing.
struct Slabs {
    mesh::TriangleMesh mesh;
    mesh::SurfaceQuery query;
    static mesh::TriangleMesh make(double gap, double floor) {
        mesh::PolygonSoup soup;
        soup.polygon_start = {0};
        const auto box = [&](const Vec3& lo, const Vec3& hi) {
            const auto first = static_cast<std::uint32_t>(soup.points.size());
            for (int i = 0; i < 8; ++i)
                soup.points.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
            static constexpr std::array<std::array<std::uint32_t, 4>, 6> quads{
                {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
            for (const auto& quad : quads) {
                for (const std::uint32_t corner : quad) soup.corners.push_back(first + corner);
                soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            }
        };
        box({-0.2, -0.1, -0.01}, {-0.5 * gap, 0.1, 0});
        box({0.5 * gap, -0.1, -0.01}, {0.2, 0.1, 0});
        if (floor > 0) box({-0.2, -0.1, -0.03}, {0.2, 0.1, -floor});
        mesh::RepairOptions metres;
        metres.metres_per_unit = 1;
        return mesh::build_surface(soup, metres).mesh;
    }
    Slabs(double gap, double floor) : mesh(make(gap, floor)), query(mesh) {}
};

struct Crossing {
    int strokes = 0;
    double least = 1e9, most = -1e9;  ///< heights of the tip when it is down, metres
    double lean = 0;                  ///< radians, most
    double step = 0;                  ///< metres, longest between poses of one stroke
};
Crossing cross(const Slabs& slabs, const brush::Preset& preset, double slant) {
    PointerSettings s;
    s.speed_effect = s.dwell_effect = 0;
    PointerInput hand(slabs.query, preset, s);
    Crossing out;
    const Vec3 down = glm::normalize(Vec3(0, std::sin(slant), -std::cos(slant))),
               up = glm::normalize(Vec3(0, std::cos(slant), std::sin(slant)));
    std::vector<brush::Pose> poses;
    const auto take = [&](const std::vector<StrokeStep>& steps, bool look) {
        for (const StrokeStep& step : steps) {
            if (step.kind == StrokeStep::Kind::begin) ++out.strokes, poses.clear();
            for (const brush::Pose& pose : step.poses) {
                if (!poses.empty()) out.step = std::max(out.step, std::abs(pose.position.x - poses.back().position.x));
                poses.push_back(pose);
                const double tip = pose.position.z - preset.length;
                if (look && pose.time > 0.4) out.least = std::min(out.least, tip), out.most = std::max(out.most, tip);
                // Tipped ahead on the first centimetre only.
                if (pose.time > 0.3) out.lean = std::max(out.lean, std::acos(std::min(1.0, -pose.axis().z)));
            }
        }
    };
    for (int i = 0; i <= 800; ++i) {
        const Vec3 at(-0.04 + 1e-4 * i, 0, 0);
        take(hand.move({.ray = {at - 0.5 * down, down},
                        .view_right = {1, 0, 0},
                        .view_up = up,
                        .metres_per_pixel = 1e-4,
                        .time = 0.001 * i}),
             true);
    }
    take(hand.lift(), false);
    return out;
}

TEST(PointerOverAGap, AGapNarrowerThanTheTuftIsCrossedInOneLevelStroke) {
    for (const char* name : {"wolf-medium", "goat-large"}) {
        const brush::Preset preset = brush::load_preset(name);
        for (const double floor : {0.0, 0.012})
            for (const double slant : {0.0, 0.7}) {
                const double gap = std::min(0.007, 1.8 * preset.radius);
                const Slabs slabs(gap, floor);
                const Crossing c = cross(slabs, preset, slant);
                EXPECT_EQ(c.strokes, 1) << name << " floor " << floor << " slant " << slant;
                // 20 µm: a five hundredth of its depth; the pressure still rises by e^-8 after 0.4 s.
                EXPECT_LT(c.most - c.least, 2e-5) << name << " floor " << floor << " slant " << slant;
                EXPECT_LT(c.lean, 0.02);
                // 0.1 m/s: 0.1 mm in each of the samples' milliseconds; six of them while it is set down; at an edge no
                // more than the reach of the snap back.
                EXPECT_LT(c.step, 8e-4);
            }
    }
}

TEST(PointerOverAGap, AGapWiderThanTheTuftEndsTheStroke) {
    const brush::Preset preset = brush::load_preset("wolf-small");
    for (const double slant : {0.0, 0.7}) EXPECT_EQ(cross(Slabs(0.02, 0), preset, slant).strokes, 2);
}

// A rim with something far behind it is none.
TEST(PointerOverAGap, AnEdgeIsNoGap) {
    const Slabs slabs(0.03, 0.013);
    const PointerInput hand(slabs.query, brush::load_preset("goat-large"), {});
    for (const double x : {-0.0155, -0.0145, -0.012, 0.0}) {
        const Aim aim{.ray = {{x, 0, 0.5}, {0, 0, -1}}, .view_up = {0, 1, 0}};
        const auto ground = hand.find_surface(aim);
        const auto hit = aim_at(slabs.query, aim);
        ASSERT_TRUE(ground && hit);
        EXPECT_FALSE(ground->bridged) << x;
        EXPECT_EQ(ground->position, hit->position) << x;
    }
}

TEST_F(PointerOnSheet, LeanTurnsTheHolderAboutTheTip) {
    PointerSettings s;
    s.tilt = {0.4, 0};
    const PointerInput hand(*query_, preset_, s);
    const auto pose = hand.hover(above(0, 0, 0));
    ASSERT_TRUE(pose);
    const Vec3 up = -pose->axis();
    EXPECT_NEAR(std::atan2(up.x, up.z), 0.4, 1e-9);
    EXPECT_NEAR(up.y, 0, 1e-9);
}

/// Direction of the broad side, radians anticlockwise from the right as seen from above.
double broad_side(const brush::Pose& pose) {
    const Vec3 x = pose.rotation * Vec3(1, 0, 0);
    return std::atan2(x.y, x.x);
}

TEST_F(PointerOnSheet, AWideFerruleLiesAcrossTheViewTurnedByRollAndPen) {
    const brush::Preset flat = brush::load_preset("flat-12");
    for (const double roll : {0.0, 0.6, -2.0})
        for (const double turn : {0.0, 0.5}) {
            const PointerInput hand(*query_, flat, {.roll = roll});
            Aim aim = above(0, 0, 0, 0.5);
            aim.turn = turn;
            const auto pose = hand.hover(aim);
            ASSERT_TRUE(pose);
            EXPECT_NEAR(broad_side(*pose), roll - turn, 1e-12);
            // The view is turned by a right angle: so is the brush.
            aim.view_right = {0, 1, 0};
            aim.view_up = {-1, 0, 0};
            EXPECT_NEAR(
                std::remainder(broad_side(*hand.hover(aim)) - roll + turn - std::numbers::pi / 2, 2 * std::numbers::pi),
                0, 1e-12);
        }
}

TEST_F(PointerOnSheet, AWideFerruleFollowsItsStrokeByTheClosedForm) {
    PointerInput hand(*query_, brush::load_preset("flat-12"), {.roll = 0.2, .roll_follow = true, .clean_ends = false});
    const Vec2 ahead = glm::normalize(Vec2(1, 2));
    std::vector<brush::Pose> poses;
    for (int i = 0; i < 200; ++i)
        for (const StrokeStep& step : hand.move(above(1e-4 * i * ahead.x, 1e-4 * i * ahead.y, 0.004 * i)))
            poses.insert(poses.end(), step.poses.begin(), step.poses.end());
    ASSERT_GT(poses.size(), 150u);
    const auto place = [&](const brush::Pose& p) { return Vec2(p.position); };
    const double across = std::atan2(-ahead.x, ahead.y);  // of y along the motion
    for (const brush::Pose& pose : poses) {
        const double s = glm::distance(place(pose), place(poses.front()));
        const double left = 2 * std::atan(std::tan(0.5 * across) * std::exp(-s / stroke::kRollLag));
        // The upright holder is over the ink to the place on the sheet, some 1e-9 m of λ.
        EXPECT_NEAR(broad_side(pose), across - left + 0.2, 1e-5);
    }
}

TEST_F(PointerOnSheet, TheTipLagFollowsATurnOfTheStrokeAsInATrace) {
    const brush::Preset flat = brush::load_preset("flat-12");
    std::vector<double> turns;
    const BrushTipLag recorded{.upright = {{0, 0}, {0.02, 0}}, .tilted = [&](double, const Vec2&, double turn) {
                                   turns.push_back(turn);
                                   return Vec2{0};
                               }};
    PointerInput hand(*query_, flat, {.smoothing = 1e-6}, recorded);
    // To the right on its edge, then up across its broad side, at 0.05 m/s.
    constexpr double kCorner = 0.03;
    std::vector<std::pair<double, double>> after;  // metres after the corner, and the turn there
    for (int i = 0; i < 300; ++i) {
        const double s = 2e-4 * i;
        turns.clear();
        hand.move(above(std::min(s, kCorner) - kCorner, std::max(0.0, s - kCorner), 0.004 * i));
        if (s > kCorner && !turns.empty()) after.emplace_back(s - kCorner, turns.back());
    }
    ASSERT_GT(after.size(), 100u);
    stroke::FollowedTurn followed(flat.length, 0);
    double gone = 0;
    for (const auto& [s, turn] : after) {
        const double expected = followed.follow(-std::numbers::pi / 2, s - gone);
        gone = s;
        // The dragged point turns the path within its string; the turn lags by the part of it that has gone: 1.5 mm.
        EXPECT_NEAR(std::remainder(turn - expected, std::numbers::pi), 0, 1.5e-3 / (0.5 * flat.length) * 1.6) << s;
    }
}

TEST_F(PointerOnSheet, ABladeTurnsWithItsHairAsInATrace) {
    const brush::Preset sword = brush::load_preset("sword-8");
    const double string = stroke::holder_options(sword, *mesh_).tip_lag_turn;
    PointerInput hand(*query_, sword, {.smoothing = 1e-6, .roll_follow = true}, {.upright = {{0, 0}, {0.02, 0}}});
    // Along a circle at 0.05 m/s, anticlockwise from the right.
    constexpr double kRadius = 0.02;
    std::vector<brush::Pose> poses;
    for (int i = 0; i < 400; ++i) {
        const double a = 2e-4 * i / kRadius;
        for (const StrokeStep& step : hand.move(above(kRadius * std::cos(a), kRadius * std::sin(a), 0.004 * i)))
            poses.insert(poses.end(), step.poses.begin(), step.poses.end());
    }
    ASSERT_GT(poses.size(), 300u);
    // The broad side across the path lies along the radius, by `a`. The hand lags by asin(λ / R) (gesture/roll.h), the
    // blade by string / R more.
    const double a = 2e-4 * 399 / kRadius, lag = std::asin(stroke::kRollLag / kRadius) + string / kRadius;
    // The path is a polygon of 0.2 mm and the cursor is smoothed over a frame.
    EXPECT_NEAR(std::remainder(broad_side(poses.back()) - (a - lag), std::numbers::pi), 0, 4e-3);
    EXPECT_GT(string / kRadius, 3 * 4e-3) << "which the blade's own lag exceeds";
}

TEST_F(PointerOnSheet, ATurnOfThePenTurnsTheTuftAboutItsHolder) {
    const PointerInput hand(*query_, preset_, {});
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

// The relative tolerance is rounding.
TEST(Orbit, AMovedAndScaledModelLooksAsBefore) {
    const Box former{Vec3(-0.1, -0.2, 0), Vec3(0.3, 0.2, 0.1)};
    for (const double scale : {1.0, 0.001, 25.4})
        for (const Vec3& shift : {Vec3(0), Vec3(3, -2, 0.5)}) {
            const Box revised{scale * former.lo + shift, scale * former.hi + shift};
            Orbit o;
            o.target = {0.05, -0.1, 0.02};
            const Vec3 p(0.2, 0.1, 0.05);
            const Vec3 before = render::picture_point(o.camera(800, 600, former), p);
            o.follow(stroke::ModelMotion{.to = shift, .scale = scale}, revised);
            const Vec3 after = render::picture_point(o.camera(800, 600, revised), scale * p + shift);
            EXPECT_NEAR(before.x, after.x, 1e-4) << scale;
            EXPECT_NEAR(before.y, after.y, 1e-4) << scale;
        }
}

TEST(Orbit, AModelOfAnotherShapeKeepsTheCameraAndIsFramedWhereItLeftTheView) {
    Orbit o;
    o.target = Vec3(0.05);
    o.follow({}, {Vec3(0), Vec3(0.1, 0.1, 0.15)});
    EXPECT_EQ(o.target, Vec3(0.05));
    EXPECT_EQ(o.distance, Orbit{}.distance);
    const Box away{Vec3(1), Vec3(1.1, 1.1, 1.2)};
    o.follow({}, away);
    EXPECT_EQ(o.target, away.centre());
}

TEST(Orbit, AStandardViewIsParallelUntilItIsTurned) {
    for (const bool parallel : {false, true}) {
        Orbit o;
        o.set_parallel(parallel);
        o.look_from(StandardView::left);
        o.look_from(StandardView::top);
        o.pan(20, 10, 500);
        o.zoom(2, Vec3(0));
        EXPECT_TRUE(o.parallel);
        const Vec3 forward = o.camera(400, 300, Box{{-1, -1, -1}, {1, 1, 1}}).forward;
        EXPECT_NEAR(forward.z, -1, 1e-12);
        o.turn(0, -3);
        EXPECT_EQ(o.parallel, parallel);
        // Asked for by name it stays.
        o.look_from(StandardView::front);
        o.set_parallel(true);
        o.turn(5, 0);
        EXPECT_TRUE(o.parallel);
    }
}

TEST(Orbit, TheModelGoesWhereTheCapIsPushedAndTurned) {
    for (const double roll : {0.0, 0.7}) {
        Orbit before;
        before.roll = roll;
        const Box scene{Vec3(-0.1), Vec3(0.1)};
        const auto picture = [&](const Orbit& o, const Vec3& p) {
            return render::picture_point(o.camera(800, 600, scene), p);
        };
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
            const Ray ray = render::ray_at(c, at.x, at.y);
            const Vec3 back = render::picture_point(c, ray.origin + 0.37 * ray.direction);
            EXPECT_NEAR(back.x, at.x, 1e-7);
            EXPECT_NEAR(back.y, at.y, 1e-7);
        }
    }
}

// A shell with a hole in its front, 30 mm across, and a far wall whose back is seen through it, 60 mm behind: a scan.
// A hand that draws over the hole does not reach through it.
TEST(HandOverAHole, StaysOnTheSideOfTheSurfaceWhereItWasSetDown) {
    mesh::PolygonSoup soup;
    soup.polygon_start.push_back(0);
    const auto add = [&](double x0, double x1, double y0, double y1, double z, bool faces_up) {
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        soup.points.insert(soup.points.end(), {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
        for (const std::uint32_t k :
             faces_up ? std::array<std::uint32_t, 4>{0, 1, 2, 3} : std::array<std::uint32_t, 4>{3, 2, 1, 0})
            soup.corners.push_back(first + k);
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    add(-0.10, -0.015, -0.1, 0.1, 0, true);
    add(0.015, 0.10, -0.1, 0.1, 0, true);
    add(-0.1, 0.1, -0.1, 0.1, -0.06, false);
    mesh::RepairOptions metres;
    metres.metres_per_unit = 1;
    const mesh::TriangleMesh mesh = mesh::build_surface(soup, metres).mesh;
    const mesh::SurfaceQuery query(mesh);
    const auto strokes_from = [&](double from, double to) {
        PointerInput hand(query, brush::load_preset("wolf-medium"), {});
        std::vector<StrokeStep> steps;
        constexpr int kSamples = 200;
        for (int i = 0; i <= kSamples; ++i) {
            const Aim aim{.ray = {{from + (to - from) * i / kSamples, 0, 0.5}, {0, 0, -1}},
                          .view_up = {0, 1, 0},
                          .metres_per_pixel = 1e-4,
                          .time = 0.004 * i};
            for (StrokeStep& step : hand.move(aim)) steps.push_back(std::move(step));
        }
        for (StrokeStep& step : hand.lift()) steps.push_back(std::move(step));
        return steps;
    };
    int begun = 0;
    double lowest = 1;
    for (const StrokeStep& step : strokes_from(-0.06, 0.06)) {
        begun += step.kind == StrokeStep::Kind::begin;
        for (const brush::Pose& pose : step.poses) lowest = std::min(lowest, pose.position.z);
    }
    EXPECT_EQ(begun, 2) << "before the hole and behind it";
    EXPECT_GT(lowest, 0) << "the mouth of the ferrule stays above the front";
    EXPECT_TRUE(strokes_from(-0.01, 0.01).empty()) << "who begins in the hole touches nothing";
    lowest = 1;
    begun = 0;
    for (const StrokeStep& step : strokes_from(-0.01, 0.06)) {
        begun += step.kind == StrokeStep::Kind::begin;
        for (const brush::Pose& pose : step.poses) lowest = std::min(lowest, pose.position.z);
    }
    EXPECT_EQ(begun, 1) << "and who goes on to the front begins there";
    EXPECT_GT(lowest, 0);
}

// A brush file is written anew under its name while the program runs.
TEST(TipLagCache, TwoBrushesOfOneNameHaveALagEach) {
    const brush::Preset one = brush::load_preset("wolf-small");
    brush::Preset other = brush::scaled(one, 2);
    other.name = one.name;
    TipLagCache cache;
    const double first = cache.find(one).upright.back().length, second = cache.find(other).upright.back().length;
    EXPECT_NEAR(second, 2 * first, 0.02 * second) << "similar tufts bend alike: the lag is a length";
    EXPECT_EQ(cache.find(one).upright.back().length, first);
}

TEST_F(PointerOnSheet, TheBackOfASheetIsPaintedOn) {
    PointerInput hand(*query_, preset_, {});
    const Vec3 c = mesh_->bounds.centre();
    std::size_t n = 0;
    for (int i = 0; i < 50; ++i)
        n += hand.move({.ray = {c + Vec3(1e-3 * i, 0, -0.5), {0, 0, 1}}, .view_up = {0, 1, 0}, .time = 0.004 * i})
                 .size();
    EXPECT_GT(n, 10u);
}

}  // namespace
}  // namespace tuft::app
