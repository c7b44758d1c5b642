#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "app/tools/aim.h"
#include "app/tools/stroke_input.h"
#include "both_programs.h"

/// A hand's samples through the window and through `tuft paint --as-pointer`.
namespace tuft::app {
namespace {

constexpr double kWidth = 640, kHeight = 480;  // pixels

class PointerThroughBothPrograms : public BothPrograms {
  protected:
    /// A hook over the bowl's front, 250 samples in a second: down, round, and off quickly.
    static std::vector<Event> hook(bool pen) {
        std::vector<Event> events;
        constexpr int kSamples = 60;
        for (int i = 0; i <= kSamples; ++i) {
            const double t = static_cast<double>(i) / kSamples;
            Event e{.kind = i == 0          ? Event::Kind::press
                            : i == kSamples ? Event::Kind::release
                                            : Event::Kind::move,
                    .time = 0.004 * i,
                    .x = std::round(310 + 30 * std::sin(4 * t)),
                    .y = std::round(250 + 50 * t * t)};
            if (pen) {
                e.pressure = 0.2 + 0.5 * t * (1 - t);
                e.tilt = {0.3 * t, -0.1};
                e.turn = 0.5 * t;
            }
            events.push_back(e);
        }
        return events;
    }

    /// Draws with the window's tool; writes the same samples, in metres on the plane of its parallel view, to a file.
    Painted drawn(const std::vector<Event>& events, const std::string& brush, bool pen) {
        Session s;
        s.view.area = {0, 0, static_cast<int>(kWidth), static_cast<int>(kHeight)};
        s.brush.preset = brush;
        s.tools.pointer.string = 2 * kMillimetre;
        const Painted painted = in_studio("bowl.ply", [&](std::unique_ptr<PaintThread>& painter) {
            s.paint_thread = std::move(painter);
            const Box bounds = s.paint_thread->model().mesh->bounds;
            s.view.orbit = {};
            s.view.orbit.frame(bounds);
            s.view.orbit.azimuth = s.view.orbit.elevation = 0;
            s.view.orbit.parallel = true;
            TipLagCache lags;
            StrokeInput input(s, lags);
            stroke::RecordedStroke recorded;
            recorded.placed = true;
            const render::GlCamera camera = camera_of(s);
            recorded.placement = {bounds.centre(), camera.right, -camera.up, stroke::SurfaceMapping::project};
            for (const Event& e : events) {
                e.kind == Event::Kind::press     ? input.press(e)
                : e.kind == Event::Kind::release ? input.release(e)
                                                 : input.move(e);
                const Vec3 at = aim_of(s, e).ray.origin - camera.eye;
                recorded.samples.push_back({.time = e.time,
                                            .position = {glm::dot(at, camera.right), -glm::dot(at, camera.up), 0},
                                            .pressure = std::max(0.0, e.pressure),
                                            .tilt = e.tilt,
                                            .roll = -e.turn});
            }
            std::string text = io::inkml_text(std::span(&recorded, 1));
            // A mouse has no pressure: to a reader the channel is one that it does not know.
            if (const std::string channel = "name=\"P\""; !pen)
                text.replace(text.find(channel), channel.size(), "name=\"B\"");
            std::ofstream(folder_ + "/hand.inkml") << text;
            painter = std::move(s.paint_thread);
            return fmt::format(
                "--strokes {}/hand.inkml --brush {} --ink carbon --as-pointer --pixel {} --smooth 1 "
                "--stabilise 2",
                folder_, brush, render::metres_per_pixel(camera, s.view.orbit.target) / kMillimetre);
        });
        return painted;
    }
};

TEST_F(PointerThroughBothPrograms, AMousesSamplesGiveTheSameJournalToTheBit) {
    const Painted studio = drawn(hook(false), "goat-small", false);
    ASSERT_EQ(studio.journal.size(), 1u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

TEST_F(PointerThroughBothPrograms, APensSamplesGiveTheSameJournalToTheBit) {
    const Painted studio = drawn(hook(true), "flat-12", true);
    ASSERT_EQ(studio.journal.size(), 1u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

}  // namespace
}  // namespace tuft::app
