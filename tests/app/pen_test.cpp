#include <gtest/gtest.h>
#include <imgui.h>

#include "app/input/imgui_feed.h"
#include "app/input/pen_samples.h"
#include "app/input/pointer.h"
#include "core/text/units.h"
#include "models.h"
#include "paths.h"

namespace tuft::app {
namespace {

// As a Wacom Intuos shows itself to XInput 2 (xinput list-props): axes 0 and 1 absolute, pressure
// 0–65536, tilt in degrees from -64 to 63.
std::map<int, PenDevice> tablet() {
    return {{11,
             {.name = "Wacom Intuos Pro M Pen stylus",
              .x = {0, 0, 44800},
              .y = {1, 0, 29600},
              .pressure = {2, 0, 65536},
              .tilt_x = {3, -64, 63},
              .tilt_y = {4, -64, 63}}},
            {12,
             {.name = "Wacom Intuos Pro M Pen eraser",
              .x = {0, 0, 44800},
              .y = {1, 0, 29600},
              .pressure = {2, 0, 65536},
              .eraser = true}}};
}
constexpr PenScreen kScreen{.left = 100, .top = 50, .width = 1280, .height = 720};

TEST(PenSamples, AxesThatDidNotChangeKeepTheirValue) {
    PenSamples pen;
    pen.set_devices(tablet());
    pen.take({.device = 11, .time = 5, .axes = {0, 1, 2, 3, 4}, .values = {22400, 14800, 32768, 30, -10}}, kScreen, 1);
    pen.take({.device = 11, .time = 5.001, .axes = {2}, .values = {65536}}, kScreen, 1.001);
    EventQueue events;
    pen.merge(events, 1.002);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_NEAR(events[0].x, 0.5 * 1280 - 100, 1e-9);
    EXPECT_NEAR(events[0].y, 0.5 * 720 - 50, 1e-9);
    EXPECT_NEAR(events[0].pressure, 0.5, 1e-9);
    EXPECT_NEAR(events[1].x, events[0].x, 1e-9);
    EXPECT_NEAR(events[1].pressure, 1, 1e-9);
    EXPECT_NEAR(events[1].tilt.x, 30 * kDegree, 1e-9);
    EXPECT_NEAR(events[1].tilt.y, -10 * kDegree, 1e-9);
    EXPECT_NEAR(events[1].time - events[0].time, 0.001, 1e-9);
}

// Wacom's art pen counts 1800 steps a turn (xinput list: Abs Wheel, -900 to 899).
TEST(PenSamples, TheTurnOfAnArtPenIsAnAngle) {
    PenSamples pen;
    auto devices = tablet();
    devices[11].turn = {5, -900, 899};
    pen.set_devices(devices);
    pen.take({.device = 11, .time = 5, .axes = {0, 1, 2}, .values = {1, 1, 1}}, kScreen, 1);
    pen.take({.device = 11, .time = 5.1, .axes = {5}, .values = {450}}, kScreen, 1.1);
    pen.take({.device = 11, .time = 5.2, .axes = {5}, .values = {-900}}, kScreen, 1.2);
    EventQueue events;
    pen.merge(events, 1.3);
    ASSERT_EQ(events.size(), 3u);
    EXPECT_EQ(events[0].turn, 0);
    EXPECT_NEAR(events[1].turn, 90 * kDegree, 1e-12);
    EXPECT_NEAR(events[2].turn, -180 * kDegree, 1e-12);
}

TEST(PenSamples, TheEraserEndIsRecognised) {
    PenSamples pen;
    pen.set_devices(tablet());
    pen.take({.device = 12, .time = 1, .axes = {0, 1, 2}, .values = {0, 0, 100}}, kScreen, 1);
    EventQueue events{{.kind = Event::Kind::press, .x = -100, .y = -50}};
    pen.merge(events, 1);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_TRUE(events[0].eraser);
    EXPECT_TRUE(events[1].eraser);
}

// The window's own movements and buttons come over another connection, so often a frame later.
TEST(PenSamples, LateCopiesOfItsMovementsDoNotInterruptTheStroke) {
    PenSamples pen;
    pen.set_devices(tablet());
    pen.take({.device = 11, .time = 5, .axes = {0, 1, 2}, .values = {22400, 14800, 32768}}, kScreen, 1);
    pen.take({.device = 11, .motion = false, .button = 1, .pressed = true, .time = 5.001}, kScreen, 1.001);
    EventQueue events{{.kind = Event::Kind::press, .x = 539, .y = 309}};
    pen.merge(events, 1.01);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[1].kind, Event::Kind::press);
    EXPECT_NEAR(events[1].x, events[0].x, 1e-12) << "where the pen is, to parts of a pixel";
    for (const double now : {1.02, 5.0, 60.0}) {  // held still, however long
        events = {{.kind = Event::Kind::move, .x = 538, .y = 308}};
        pen.merge(events, now);
        EXPECT_TRUE(events.empty()) << now;
    }
    events = {{.kind = Event::Kind::release, .x = 538, .y = 308}};
    pen.merge(events, 60.1);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_NEAR(events[0].pressure, 0.5, 1e-9);
    // The pen's own word on it comes late and changes nothing; then the mouse is a mouse again.
    pen.take({.device = 11, .motion = false, .button = 1, .pressed = false, .time = 64.1}, kScreen, 60.11);
    events = {};
    pen.merge(events, 60.12);
    EXPECT_TRUE(events.empty());
    events = {{.kind = Event::Kind::move, .x = 7}, {.kind = Event::Kind::press, .x = 7}};
    pen.merge(events, 61);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[1].x, 7);
    EXPECT_LT(events[1].pressure, 0);
}

TEST(PenSamples, TwoDotsWithinOneFrameAreTwo) {
    PenSamples pen;
    pen.set_devices(tablet());
    double t = 5;
    const auto at = [&](double x) {
        pen.take({.device = 11, .time = t += 0.001, .axes = {0, 1, 2}, .values = {x, 14800, 30000}}, kScreen, 1);
    };
    const auto button = [&](bool pressed) {
        pen.take({.device = 11, .motion = false, .button = 1, .pressed = pressed, .time = t += 0.001}, kScreen, 1);
    };
    const Event down{.kind = Event::Kind::press}, up{.kind = Event::Kind::release};
    at(10000), button(true), at(10100), button(false), at(12000), button(true), at(12100), button(false);
    // The window saw no more than the first three yet; the fourth comes with the next frame.
    EventQueue events{down, up, down};
    pen.merge(events, 1.02);
    std::string order;
    for (const Event& e : events) order += e.kind == Event::Kind::move ? 'm' : e.kind == Event::Kind::press ? 'd' : 'u';
    EXPECT_EQ(order, "mdmumdm");
    at(20000);
    EventQueue more{up};
    pen.merge(more, 1.04);
    ASSERT_EQ(more.size(), 2u);
    EXPECT_EQ(more[0].kind, Event::Kind::release);
    EXPECT_EQ(more[0].x, events.back().x);
    EXPECT_GT(more[1].x, more[0].x);
}

TEST(PenSamples, AnUnpluggedTabletIsNoticedAndItsLateReportsAreHarmless) {
    PenSamples pen;
    EXPECT_FALSE(pen.set_devices(tablet()));
    EXPECT_FALSE(pen.set_devices(tablet()));
    EXPECT_TRUE(pen.set_devices({}));
    pen.take({.device = 11, .axes = {2, 3}, .values = {1}}, kScreen, 1);
    EventQueue events{{.kind = Event::Kind::move, .x = 7}};
    pen.merge(events, 1);
    ASSERT_EQ(events.size(), 1u);  // the mouse goes on
    EXPECT_EQ(events[0].x, 7);
}

// A second of a pen that reports a thousand times, while the window draws fifteen pictures.
TEST(PenSamples, OfAThousandReportsASecondNoneIsLostOnItsWayToTheBrush) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const brush::Preset preset = brush::load_preset("wolf-small");
    PointerInput hand(query, preset, {});
    PenSamples pen;
    pen.set_devices(tablet());
    ImGui::CreateContext();
    start_imgui_feed();
    EventQueue queue;
    std::size_t moves = 0;
    std::vector<double> depths;
    double last_time = -1;
    for (int i = 0; i < 1000; ++i) {
        const double t = i * 1e-3, pressure = 0.5 + 0.4 * std::sin(20 * t);
        pen.take(
            {.device = 11, .time = 100 + t, .axes = {0, 1, 2}, .values = {20000.0 + 2 * i, 14800, 65536 * pressure}},
            kScreen, 3 + t);
        if (i % 67 != 66 && i != 999) continue;  // a frame
        EventQueue fresh{{.kind = Event::Kind::move, .x = 1},
                         {.kind = Event::Kind::move, .x = 2}};  // the server's own copies
        pen.merge(fresh, 3 + t);
        queue.insert(queue.end(), fresh.begin(), fresh.end());
        for (const Event& e : feed_imgui(queue, 1280, 720, 0.067)) {
            ASSERT_EQ(e.kind, Event::Kind::move);
            ++moves;
            EXPECT_GT(e.time, last_time);
            last_time = e.time;
            const Aim aim{.ray = {mesh.bounds.centre() + Vec3(1e-4 * (e.x - 500), 0, 0.5), {0, 0, -1}},
                          .time = e.time,
                          .pressure = e.pressure};
            for (const StrokeStep& step : hand.move(aim))
                for (const brush::Pose& pose : step.poses)
                    depths.push_back(preset.length - (pose.position.z - mesh.bounds.hi.z));
        }
    }
    ImGui::DestroyContext();
    EXPECT_EQ(moves, 1000u);
    ASSERT_EQ(depths.size(), 1000u);
    // The depth follows the pressure with the hand's time constant of 4 ms, over which it changes by at most 4 ms ·
    // 20/s · 0.4.
    for (std::size_t i = 100; i < 1000; ++i) {
        const double pressure = 0.5 + 0.4 * std::sin(20 * 1e-3 * static_cast<double>(i));
        EXPECT_NEAR(depths[i] / stroke::working_depth(preset), pressure, 0.034) << i;
    }
}

}  // namespace
}  // namespace tuft::app
