#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>

#include <algorithm>

#include "brush/preset/preset.h"
#include "core/text/units.h"
#include "paths.h"
#include "stroke/placement/placement.h"
#include "window.h"

/// A Wacom tablet from its kernel events on: the real X server with the real driver reads an event device
/// (umockdev) that the test writes to; the window gets them through XInput 2, and paints.
namespace tuft::app {
namespace {

namespace fs = std::filesystem;

class Tablet : public test::Window {
  protected:
    static constexpr int kWide = 44704, kHigh = 27940, kPressed = 2047;  // ranges of tablet/pen.ioctl
    static constexpr int kScreenWidth = 1280, kScreenHeight = 720;       // of tablet/xorg.conf

    void SetUp() override {
        for (const char* tool : {"Xorg", "umockdev-run", "xdotool"})
            if (!installed(tool)) GTEST_SKIP() << tool << " is not installed: no tablet is tested";
        const fs::path modules = "/usr/lib/xorg/modules";
        for (const char* driver : {"input/wacom_drv.so", "input/inputtest_drv.so", "drivers/dummy_drv.so"})
            if (!fs::exists(modules / driver))
                GTEST_SKIP() << "the X server has no " << driver << ": no tablet is tested";
        if (geteuid() != 0) GTEST_SKIP() << "only root may start an X server without a terminal: no tablet is tested";
        make_folder();
        std::string config = read(source_folder() + "/tests/app/tablet/xorg.conf");
        for (std::size_t at; (at = config.find("@DIR@")) != std::string::npos;) config.replace(at, 5, folder_.string());
        std::ofstream(path("xorg.conf")) << config;
        ASSERT_EQ(mkfifo(path("events").c_str(), 0600), 0);
        // The device of the test bed becomes a pipe, so that events can be written while the server runs.
        std::ofstream(path("server")) << "echo $$ >'" << path("server.pid") << "'; ln -sf '" << path("events")
                                      << "' \"$UMOCKDEV_DIR/dev/input/event5\"; exec Xorg -config '"
                                      << path("xorg.conf") << "' -logfile '" << path("xorg.log")
                                      << "' -displayfd 3 -noreset -nolisten tcp -novtswitch -sharevts 3>'"
                                      << path("display") << "'\n";
        server_ = start(
            {"umockdev-run", "-d", source_folder() + "/tests/app/tablet/pen.umockdev", "-i",
             "/dev/input/event5=" + source_folder() + "/tests/app/tablet/pen.ioctl", "--", "bash", path("server")},
            "");
        take_display();
        pen_ = open(path("events").c_str(), O_WRONLY | O_NONBLOCK);
        ASSERT_GE(pen_, 0) << read("xorg.log");
    }
    void TearDown() override {
        if (pen_ >= 0) close(pen_);
        if (const int pid = std::atoi(read("server.pid").c_str()); pid > 1) kill(pid, SIGTERM);
        Window::TearDown();
    }

    struct Word {
        int type, code, value;
    };
    void say(std::initializer_list<Word> words) const {
        std::vector<input_event> events;
        timeval now{};
        gettimeofday(&now, nullptr);
        const auto add = [&](const Word& w) {
            input_event e{};
            e.input_event_sec = now.tv_sec;
            e.input_event_usec = now.tv_usec;
            e.type = static_cast<__u16>(w.type);
            e.code = static_cast<__u16>(w.code);
            e.value = w.value;
            events.push_back(e);
        };
        for (const Word& w : words) add(w);
        add({EV_SYN, SYN_REPORT, 0});
        const auto bytes = static_cast<ssize_t>(events.size() * sizeof(input_event));
        ASSERT_EQ(write(pen_, events.data(), static_cast<std::size_t>(bytes)), bytes);
    }
    // One sample: a place in the window (which is at the screen's corner), pressure 0–1, tilt in degrees.
    void sample(double x, double y, double pressure, int tilt_x, int tilt_y) const {
        say({{EV_ABS, ABS_X, static_cast<int>(x * kWide / kScreenWidth)},
             {EV_ABS, ABS_Y, static_cast<int>(y * kHigh / kScreenHeight)},
             {EV_ABS, ABS_PRESSURE, static_cast<int>(pressure * kPressed)},
             {EV_ABS, ABS_TILT_X, tilt_x},
             {EV_ABS, ABS_TILT_Y, tilt_y},
             {EV_KEY, BTN_TOUCH, pressure > 0}});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    // From one place to the other with a tool: half the way with one pressure and tilt, then with another.
    void stroke(int tool) const {
        say({{EV_ABS, ABS_X, static_cast<int>((kFrom.x - 10) * kWide / kScreenWidth)},
             {EV_ABS, ABS_Y, static_cast<int>(kFrom.y * kHigh / kScreenHeight)},
             {EV_ABS, ABS_DISTANCE, 20},
             {EV_KEY, tool, 1}});
        for (int i = 0; i < 20; ++i) sample(kFrom.x - 0.5 * (20 - i), kFrom.y, 0, 30, 0);
        for (int i = 0; i <= kSteps; ++i) {
            const double s = static_cast<double>(i) / kSteps;
            const bool first = 2 * i < kSteps;
            sample(kFrom.x + s * (kTo.x - kFrom.x), kFrom.y + s * (kTo.y - kFrom.y), first ? 0.3 : 0.7,
                   first ? 30 : -10, first ? 0 : 20);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // held still
        sample(kTo.x, kTo.y, 0, -10, 20);
        say({{EV_KEY, tool, 0}});
    }

    static constexpr Vec2 kFrom{440, 300}, kTo{600, 340};  // pixels
    static constexpr int kSteps = 400;
    int pen_ = -1;
};

TEST_F(Tablet, PressureTiltAndEraserComeFromTheDeviceToTheStroke) {
    std::ofstream(path("script"))
        << "open " + source_folder() +
               "/models/sheet.ply\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\n"
               "set elevation 90\nset azimuth 0\nset string 0\nset clean-ends off\nwait 0.1\nscreenshot "
        << path("ready.png") << "\nawait strokes 1\nwait-ready\nscreenshot " << path("one.png")
        << "\nawait strokes 2\nwait-ready\nscreenshot " << path("two.png")
        << "\nawait strokes 3\nwait-ready\nreport\nsave " << path("work.tuft") << "\nwait-ready\nexpect kept\n";
    open_studio("", {"--script", path("script")}, "out");
    wait_for("the model", [&] { return fs::exists(path("ready.png")); });
    stroke(BTN_TOOL_PEN);
    wait_for("the pen's stroke", [&] { return fs::exists(path("one.png")); });
    stroke(BTN_TOOL_RUBBER);
    wait_for("the eraser's stroke", [&] { return fs::exists(path("two.png")); });
    // A pointer that is warped counts for the device that moved last; now that is the mouse.
    run("xdotool mousemove_relative -- 3 3 sleep 0.3 mousemove 440 300 sleep 0.5");
    Window::stroke(
        {{static_cast<int>(kFrom.x), static_cast<int>(kFrom.y)}, {static_cast<int>(kTo.x), static_cast<int>(kTo.y)}});
    int status = -1;
    waitpid(studio_, &status, 0);
    studio_ = 0;
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << read("log");

    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 3u);
    // The driver stamps reports when it reads them. Where it could not run, a hand's path comes in no time at all.
    for (int k : {0, 1}) {
        const auto& samples = stroke::samples_of(strokes[static_cast<std::size_t>(k)]).samples;
        std::size_t clump = 0;
        for (std::size_t i = 1; i < samples.size(); ++i) {
            clump = samples[i].time - samples[i - 1].time < 5e-4 ? clump + 1 : 0;
            if (clump > kSteps / 10)
                GTEST_SKIP() << "the machine is too busy to play a hand: more than " << clump
                             << " reports came at once";
        }
    }
    EXPECT_FALSE(strokes[0].get<stroke::PaintStroke>().erases());
    EXPECT_TRUE(strokes[1].get<stroke::PaintStroke>().erases());
    EXPECT_FALSE(strokes[2].get<stroke::PaintStroke>().erases());

    const brush::Preset brush = brush::load_preset(stroke::brush_of(strokes[0]));  // the one in the size of the model
    const double working = stroke::working_depth(brush);
    struct HolderPose {
        double pressure;
        Vec2 lean;  // tangents, to the right and away from the hand
        Vec3 foot;  // of the holder's axis on the sheet, metres
    };
    const auto held = [&](const stroke::StrokeSample& s) {
        const Vec3 up = s.rotation * Vec3(0, 0, 1);
        const double height = s.position.z / up.z;
        return HolderPose{(brush.length - height) / working, {up.x / up.z, up.y / up.z}, s.position - height * up};
    };
    for (int k : {0, 1}) {
        const auto& samples = stroke::samples_of(strokes[static_cast<std::size_t>(k)]).samples;
        ASSERT_GT(samples.size(), static_cast<std::size_t>(kSteps)) << "each report of the tablet is a pose";
        // Twenty reports are written in 40 ms. A server that gets no turn for so long stamps them when it reads them,
        // and the hand's filter sees a jump: a few do no harm.
        std::size_t hurried = 0, late = 0;
        for (std::size_t i = 20; i + 13 < samples.size(); ++i) {
            const bool at_once = samples[i].time - samples[i - 20].time < 0.01;
            hurried += at_once;
            late += at_once && i + 80 > samples.size();
        }
        if (hurried > samples.size() / 8 || late > 0)
            GTEST_SKIP() << "the machine is too busy for a tablet: reports are read many at once";
        std::size_t light = 0, firm = 0;
        for (const stroke::StrokeSample& s : samples) {
            const HolderPose h = held(s);
            // The device has 2047 steps of pressure and whole degrees; on the steps between two of the driver's
            // averages (4 reports) and of the hand (4 ms) there is neither.
            light += std::abs(h.pressure - 0.3) < 1e-3 && glm::distance(h.lean, Vec2(std::tan(30 * kDegree), 0)) < 1e-6;
            firm += std::abs(h.pressure - 0.7) < 1e-3 &&
                    glm::distance(h.lean, Vec2(std::tan(-10 * kDegree), -std::tan(20 * kDegree))) < 1e-6;
        }
        EXPECT_GT(light, kSteps * 2 / 5u) << k;
        EXPECT_GT(firm, kSteps * 2 / 5u) << k;
        // The lift is the last twelve, the report that ends the pressure some four before; until then the pen was
        // held firmly, though the driver said nothing for 200 ms.
        EXPECT_NEAR(held(samples[samples.size() - 20]).pressure, 0.7, 1e-3) << k;
    }
    // It ends where a mouse on the same pixels ends: within a pixel for each's rounding.
    const auto& mouse = stroke::samples_of(strokes[2]).samples;
    const Vec3 from = held(mouse[1]).foot, to = held(mouse[mouse.size() - 13]).foot;
    const double pixel = glm::distance(from, to) / glm::distance(kFrom, kTo);
    for (int k : {0, 1}) {
        const auto& samples = stroke::samples_of(strokes[static_cast<std::size_t>(k)]).samples;
        EXPECT_LT(glm::distance(held(samples[samples.size() - 13]).foot, to), 2 * pixel) << k;
    }
}

}  // namespace
}  // namespace tuft::app
