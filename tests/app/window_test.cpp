#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "io/project.h"
#include "projects.h"
#include "space_daemon.h"

/// The real window on a real X server, driven as by a person's hand through XTEST.
namespace tuft::app {
namespace {

namespace fs = std::filesystem;

class Window : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* tool : {"Xvfb", "xdotool"})
            if (std::system((std::string("command -v ") + tool + " >/dev/null").c_str()) != 0) GTEST_SKIP() << tool << " is not installed: no window is tested";
        folder_ = fs::path(testing::TempDir()) / ("tuft_window_" + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        server_ = start({"Xvfb", "-displayfd", "3", "-screen", "0", "1000x640x24", "-nolisten", "tcp", "-noreset"}, "3>'" + path("display") + "'");
        wait_for("the X server", [&] { return read("display").find('\n') != std::string::npos; });
        display_ = ":" + read("display").substr(0, read("display").find('\n'));
    }
    void TearDown() override {
        end(studio_, SIGKILL);
        end(server_, SIGTERM);
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string read(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    pid_t start(const std::vector<std::string>& words, const std::string& rest) const {
        std::string line = "exec";
        for (const std::string& word : words) line += " '" + word + "'";
        line += " >>'" + path("log") + "' 2>&1 " + rest;
        const pid_t child = fork();
        if (child == 0) {
            execl("/bin/bash", "bash", "-c", line.c_str(), nullptr);
            _exit(127);
        }
        return child;
    }
    static void end(pid_t& child, int signal) {
        if (child <= 0) return;
        kill(child, signal);
        int status = 0;
        waitpid(child, &status, 0);
        child = 0;
    }
    // The clock only bounds how long a broken program is waited for.
    void wait_for(const std::string& what, const std::function<bool()>& done) const {
        for (int i = 0; i < 900; ++i) {
            if (done()) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        throw std::runtime_error("waited in vain for " + what + "\n" + read("log"));
    }
    void open_studio(const std::string& file, std::vector<std::string> options = {}, const std::string& out = "") {
        setenv("DISPLAY", display_.c_str(), 1);
        setenv("TUFT_DATA", TUFT_SOURCE, 1);
        setenv("XDG_STATE_HOME", path("state").c_str(), 1);
        options.insert(options.begin(), {TUFT_STUDIO_PROGRAM, "--size", "1000x640"});
        if (!file.empty()) options.push_back(file);
        studio_ = start(options, out.empty() ? "" : ">'" + path(out) + "'");
        wait_for("the window", [&] { return run("xdotool search --name 'tuft studio'") == 0; });
        run("xdotool search --name 'tuft studio' windowfocus");
    }
    int run(const std::string& line) const { return std::system(("DISPLAY=" + display_ + " " + line + " >/dev/null 2>&1").c_str()); }
    void keys(const std::string& words) const { run("xdotool key --delay 120 " + words); }
    void type(const std::string& text) const { run("xdotool type --delay 15 '" + text + "'"); }
    bool titled(const std::string& title) const { return run("xdotool search --name '" + title + "'") == 0; }
    // A stroke along points, some pixels at a time, as a hand moves.
    void stroke(const std::vector<std::pair<int, int>>& points) const {
        std::string line = "xdotool mousemove " + std::to_string(points[0].first) + " " + std::to_string(points[0].second) + " sleep 0.25 mousedown 1 sleep 0.1";
        for (std::size_t i = 1; i < points.size(); ++i)
            for (int k = 1; k <= 12; ++k) {
                const auto at = [&](int a, int b) { return std::to_string(a + (b - a) * k / 12); };
                line += " mousemove " + at(points[i - 1].first, points[i].first) + " " + at(points[i - 1].second, points[i].second) + " sleep 0.01";
            }
        run(line + " sleep 0.15 mouseup 1 sleep 0.15");
    }
    // Strokes in the project that is being worked on; -1: there is none yet.
    int kept(const std::string& file = "") const {
        std::string found = file;
        std::error_code ec;
        if (file.empty())
            for (const auto& entry : fs::directory_iterator(path("state") + "/tuft/sessions", ec))
                if (entry.path().extension() == ".tuft") found = entry.path();
        if (found.empty() || !fs::exists(found)) return -1;
        try {
            return static_cast<int>(io::Project::open(found).n_strokes());
        } catch (const std::exception&) {
            return -1;  // being written
        }
    }
    nlohmann::json tuft(const std::string& arguments) const {
        return test::tuft(arguments, path("tuft.json"));
    }

    fs::path folder_;
    std::string display_;
    pid_t server_ = 0, studio_ = 0;
};

// Opens, unwraps, paints, undoes, is killed, recovers, saves and exports; the texels are those of a
// replay, and those that `tuft paint` makes of the exported strokes, to the bit, and the exported model is valid.
TEST_F(Window, AnAfternoonWithAKillInItLosesNothing) {
    open_studio(TUFT_SOURCE "/models/plate.ply");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    // Enter agrees to what the dialog proposes, once it is there.
    wait_for("the model", [&] { return keys("Return"), titled("plate"); });
    wait_for("the project", [&] { return kept() == 0; });
    stroke({{460, 300}, {520, 330}, {560, 300}});
    wait_for("a stroke", [&] { return kept() == 1; });
    stroke({{480, 340}, {540, 320}});
    wait_for("two strokes", [&] { return kept() == 2; });
    keys("ctrl+z");
    wait_for("undo", [&] { return kept() == 1; });
    keys("ctrl+shift+z");
    wait_for("redo", [&] { return kept() == 2; });
    end(studio_, SIGKILL);

    open_studio("");
    wait_for("the recovery", [&] { return keys("Return"), titled("plate"); });
    std::this_thread::sleep_for(std::chrono::seconds(1));
    stroke({{450, 280}, {500, 290}});
    wait_for("three strokes", [&] { return kept() == 3; });
    keys("ctrl+s");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    keys("ctrl+a");
    type(path("work.tuft"));
    keys("Return");
    wait_for("the saved project", [&] { return kept(path("work.tuft")) == 3; });
    keys("ctrl+e");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    keys("Return");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    keys("ctrl+a");
    type(path("work.glb"));
    keys("Return");
    wait_for("the exported model", [&] { return fs::exists(path("work.glb")); });
    keys("ctrl+e");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    keys("Return");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    keys("ctrl+a");
    type(path("work.inkml"));
    keys("Return");
    wait_for("the exported strokes", [&] { return fs::exists(path("work.inkml")); });
    keys("ctrl+q");
    int status = -1;
    waitpid(studio_, &status, 0);
    studio_ = 0;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << read("log");

    const nlohmann::json replayed = tuft("replay '" + path("work.tuft") + "'");
    EXPECT_EQ(replayed["strokes"], 3);
    EXPECT_EQ(replayed["canvas_hash"], test::stored_hash(path("work.tuft")));
    const std::string size = std::to_string(io::Project::open(path("work.tuft")).model().atlas.size);
    const nlohmann::json painted = tuft("paint " TUFT_SOURCE "/models/plate.ply --strokes '" + path("work.inkml") + "' --atlas-size " + size);
    EXPECT_EQ(painted["strokes"].size(), 3u);
    EXPECT_EQ(painted["canvas_hash"], test::stored_hash(path("work.tuft")));
    const int valid = std::system(("bash '" TUFT_SOURCE "/tests/io/validate_glb.sh' '" TUFT_SOURCE "/build/node' '" + path("work.glb") + "' >'" + path("valid") + "' 2>&1").c_str());
    if (WEXITSTATUS(valid) == 77) std::puts("the glTF validator is not installed: the exported file is not checked");
    else EXPECT_EQ(valid, 0) << read("valid");
}

// The spacenav daemon, played by the test, turns the model; its device is pulled out; the hand paints on.
TEST_F(Window, ASpaceMouseTurnsTheModelAndMayBePulledOut) {
    test::SpaceDaemon daemon(path("spnav"));
    setenv("SPNAV_SOCKET", path("spnav").c_str(), 1);
    std::ofstream(path("script")) << "open " TUFT_SOURCE "/models/bowl.ply\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\n"
                                     "report\nscreenshot " << path("ready.png") << "\nawait message unplugged\nreport\n"
                                     "stroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 1\nexpect kept\n";
    open_studio("", {"--script", path("script")}, "out");
    if (!daemon.accept()) GTEST_SKIP() << "built without libspnav: no SpaceMouse is tested";
    wait_for("the model", [&] { return fs::exists(path("ready.png")); });
    run("xdotool search --name 'tuft studio' windowfocus --sync");
    daemon.motion({0, 0, 0, 0, 350, 0});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    daemon.device(1);
    int status = -1;
    waitpid(studio_, &status, 0);
    studio_ = 0;
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << read("log");
    std::istringstream reports(read("out"));
    std::string first, second;
    std::getline(reports, first);
    std::getline(reports, second);
    const auto before = nlohmann::json::parse(first), after = nlohmann::json::parse(second);
    // Two radians a second; how long the cap stood is up to the machine, but not under what was slept less one look.
    EXPECT_LT(after["azimuth_deg"].get<double>(), before["azimuth_deg"].get<double>() - 10);
    EXPECT_EQ(after["elevation_deg"], before["elevation_deg"]);
    EXPECT_EQ(after["distance_mm"], before["distance_mm"]);
}

}  // namespace
}  // namespace tuft::app
