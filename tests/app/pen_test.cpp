#include "app/pen_samples.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include "app/hand.h"
#include "app/imgui_feed.h"
#include "core/units.h"
#include "models.h"

namespace tuft::app {
namespace {

// As a Wacom Intuos shows itself to XInput 2 (xinput list-props): axes 0 and 1 absolute, pressure
// 0–65536, tilt in degrees from -64 to 63.
std::map<int, PenDevice> tablet() {
    return {{11, {.name = "Wacom Intuos Pro M Pen stylus", .x = {0, 0, 44800}, .y = {1, 0, 29600}, .pressure = {2, 0, 65536},
                  .tilt_x = {3, -64, 63}, .tilt_y = {4, -64, 63}}},
            {12, {.name = "Wacom Intuos Pro M Pen eraser", .x = {0, 0, 44800}, .y = {1, 0, 29600}, .pressure = {2, 0, 65536}, .eraser = true}}};
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

TEST(PenSamples, TheEraserEndIsToldApart) {
    PenSamples pen;
    pen.set_devices(tablet());
    pen.take({.device = 12, .time = 1, .axes = {0, 1, 2}, .values = {0, 0, 100}}, kScreen, 1);
    EventQueue events{{.kind = Event::Kind::press}};
    pen.merge(events, 1);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_TRUE(events[0].eraser);
    EXPECT_TRUE(events[1].eraser);
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
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(TUFT_SOURCE "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const brush::Preset preset = brush::load_preset("wolf-small");
    Hand hand(query, preset, {});
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
        pen.take({.device = 11, .time = 100 + t, .axes = {0, 1, 2}, .values = {20000.0 + 2 * i, 14800, 65536 * pressure}}, kScreen, 3 + t);
        if (i % 67 != 66 && i != 999) continue;  // a frame
        EventQueue fresh{{.kind = Event::Kind::move, .x = 1}, {.kind = Event::Kind::move, .x = 2}};  // the server's own copies
        pen.merge(fresh, 3 + t);
        queue.insert(queue.end(), fresh.begin(), fresh.end());
        for (const Event& e : feed_imgui(queue, 1280, 720, 0.067)) {
            ASSERT_EQ(e.kind, Event::Kind::move);
            ++moves;
            EXPECT_GT(e.time, last_time);
            last_time = e.time;
            const Aim aim{.ray = {mesh.bounds.centre() + Vec3(1e-4 * (e.x - 500), 0, 0.5), {0, 0, -1}}, .time = e.time, .pressure = e.pressure};
            for (const HandStep& step : hand.move(aim))
                for (const brush::Pose& pose : step.poses) depths.push_back(preset.length - (pose.position.z - mesh.bounds.hi.z));
        }
    }
    ImGui::DestroyContext();
    EXPECT_EQ(moves, 1000u);
    ASSERT_EQ(depths.size(), 1000u);
    // The depth follows the pressure with the hand's time constant of 4 ms, over which it changes by at most 4 ms · 20/s · 0.4.
    for (std::size_t i = 100; i < 1000; ++i) {
        const double pressure = 0.5 + 0.4 * std::sin(20 * 1e-3 * static_cast<double>(i));
        EXPECT_NEAR(depths[i] / stroke::working_depth(preset), pressure, 0.034) << i;
    }
}

}  // namespace
}  // namespace tuft::app
