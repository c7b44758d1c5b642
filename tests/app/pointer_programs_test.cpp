#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "app/tools/aim.h"
#include "app/tools/stroke_input.h"
#include "both_programs.h"

/// A hand's samples through the window and through `tuft paint --as-pointer`.
namespace tuft::app {
namespace {

constexpr double kWidth = 640, kHeight = 480;  // pixels
constexpr double kPi = std::numbers::pi;

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

    /// From the middle of the bowl off to the right and back, half a second.
    static std::vector<Event> excursion() {
        std::vector<Event> events;
        constexpr int kSamples = 120;
        for (int i = 0; i <= kSamples; ++i) {
            const double t = static_cast<double>(i) / kSamples;
            events.push_back({.kind = i == 0          ? Event::Kind::press
                                      : i == kSamples ? Event::Kind::release
                                                      : Event::Kind::move,
                              .time = 0.004 * i,
                              .x = std::round(320 + 310 * std::sin(kPi * t)),
                              .y = std::round(230 + 30 * t)});
        }
        return events;
    }

    struct Hand {
        std::string brush = "goat-small";
        bool pen = false;
        bool persistent = false;
        std::string model = "bowl.ply";
        std::vector<std::string> hidden = {};  ///< parts
    };

    /// Draws strokes with the window's tool; writes the same samples, in metres on the plane of its parallel view, to a
    /// file.
    Painted drawn(const std::vector<std::vector<Event>>& strokes, const Hand& hand) {
        Session s;
        s.view.area = {0, 0, static_cast<int>(kWidth), static_cast<int>(kHeight)};
        s.brush.preset = hand.brush;
        s.brush.persistent = hand.persistent;
        s.tools.pointer.string = 2 * kMillimetre;
        return in_studio(hand.model, [&](std::unique_ptr<PaintThread>& painter) {
            if (!hand.hidden.empty()) painter->post(ChangeParts{stroke::hidden_parts({}, hand.hidden, true)});
            painter->wait_idle(60);
            painter->take();  // as each frame of the window
            s.paint_thread = std::move(painter);
            const Box bounds = s.paint_thread->model().mesh->bounds;
            s.view.orbit = {};
            s.view.orbit.frame(bounds);
            s.view.orbit.azimuth = s.view.orbit.elevation = 0;
            s.view.orbit.parallel = true;
            TipLagCache lags;
            StrokeInput input(s, lags);
            const render::GlCamera camera = camera_of(s);
            std::vector<stroke::RecordedStroke> recorded;
            for (const std::vector<Event>& events : strokes) {
                stroke::RecordedStroke& record = recorded.emplace_back();
                record.placed = true;
                record.placement = {bounds.centre(), camera.right, -camera.up, stroke::SurfaceMapping::project};
                for (const Event& e : events) {
                    e.kind == Event::Kind::press     ? input.press(e)
                    : e.kind == Event::Kind::release ? input.release(e)
                                                     : input.move(e);
                    const Vec3 at = aim_of(s, e).ray.origin - camera.eye;
                    record.samples.push_back({.time = e.time,
                                              .position = {glm::dot(at, camera.right), -glm::dot(at, camera.up), 0},
                                              .pressure = std::max(0.0, e.pressure),
                                              .tilt = e.tilt,
                                              .roll = -e.turn});
                }
            }
            std::string text = io::inkml_text(recorded);
            // A mouse has no pressure: to a reader the channel is one that it does not know.
            if (const std::string channel = "name=\"P\""; !hand.pen)
                text.replace(text.find(channel), channel.size(), "name=\"B\"");
            std::ofstream(folder_ + "/hand.inkml") << text;
            painter = std::move(s.paint_thread);
            std::string words = fmt::format(
                "--strokes {}/hand.inkml --brush {} --ink carbon --as-pointer --pixel {} --smooth 1 --stabilise 2",
                folder_, hand.brush, render::metres_per_pixel(camera, s.view.orbit.target) / kMillimetre);
            for (const std::string& part : hand.hidden) words += " --hide-parts " + part;
            return hand.persistent ? words + " --dip persistent" : words;
        });
    }

    /// Two sheets of 100 mm with 8 x 8 squares, the part "pane" 10 mm before the part "wall". Returns the file.
    std::string pane_before_wall() const {
        const std::string path = folder_ + "/pane.obj";
        std::ofstream file(path);
        constexpr int n = 8;
        for (const double y : {-10, 0})
            for (int k = 0; k <= n; ++k)
                for (int i = 0; i <= n; ++i) file << "v " << 100.0 / n * i << ' ' << y << ' ' << 100.0 / n * k << '\n';
        for (const int sheet : {0, 1}) {
            file << "g " << (sheet == 0 ? "pane" : "wall") << '\n';
            for (int k = 0; k < n; ++k)
                for (int i = 0; i < n; ++i) {
                    const int a = 1 + sheet * (n + 1) * (n + 1) + k * (n + 1) + i;
                    file << "f " << a << ' ' << a + 1 << ' ' << a + n + 2 << ' ' << a + n + 1 << '\n';
                }
        }
        return path;
    }
};

TEST_F(PointerThroughBothPrograms, AMousesSamplesGiveTheSameJournalToTheBit) {
    const Painted studio = drawn({hook(false)}, {});
    ASSERT_EQ(studio.journal.size(), 1u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

TEST_F(PointerThroughBothPrograms, APensSamplesGiveTheSameJournalToTheBit) {
    const Painted studio = drawn({hook(true)}, {.brush = "flat-12", .pen = true});
    ASSERT_EQ(studio.journal.size(), 1u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

TEST_F(PointerThroughBothPrograms, AMouseThatLeavesTheModelAndReturnsGivesTheSameTwoStrokes) {
    const Painted studio = drawn({excursion()}, {});
    ASSERT_EQ(studio.journal.size(), 2u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

TEST_F(PointerThroughBothPrograms, StrokesWithABrushThatStaysInHandAreTheSame) {
    std::vector<Event> second = hook(false);
    for (Event& e : second) e.time += 2, e.x -= 60;
    const Painted studio = drawn({hook(false), second}, {.persistent = true});
    ASSERT_EQ(studio.journal.size(), 2u);
    expect_same(studio, by_program("paint", "bowl.ply", studio.words));
}

TEST_F(PointerThroughBothPrograms, AStrokePassesAHiddenPartAndLandsOnWhatLiesBehind) {
    const std::string model = pane_before_wall();
    const Painted on_pane = drawn({hook(false)}, {.model = model});
    const Painted studio = drawn({hook(false)}, {.model = model, .hidden = {"pane"}});
    ASSERT_EQ(on_pane.journal.size(), 1u);
    ASSERT_EQ(studio.journal.size(), 2u);  // the part is hidden, then the stroke
    expect_same(studio, by_program("paint", model, studio.words));
    const auto first = [](const Painted& p) { return stroke::samples_of(p.journal.back()).samples.front().position; };
    // Parallel sheets: the same holder 10 mm further on, but for round-off and the smoothing of the normal.
    EXPECT_NEAR(first(studio).y - first(on_pane).y, 10 * kMillimetre, 0.1 * kMillimetre);
}

}  // namespace
}  // namespace tuft::app
