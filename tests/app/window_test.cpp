#include "window.h"

#include "paths.h"
#include "space_daemon.h"

namespace tuft::app {
namespace {

namespace fs = std::filesystem;
using test::Window;

// Opens, unwraps, paints, undoes, is killed, recovers, saves and exports; the texels are those of a
// replay, and those that `tuft paint` makes of the exported strokes, to the bit, and the exported model is valid.
TEST_F(Window, AnAfternoonWithAKillInItLosesNothing) {
    open_studio(source_folder() + "/models/sphere.ply");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    // Enter agrees to what the dialog proposes, once it is there.
    wait_for("the model", [&] { return keys("Return"), titled("sphere"); });
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
    wait_for("the recovery", [&] { return keys("Return"), titled("sphere"); });
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
    const nlohmann::json painted = tuft("paint " + source_folder() + "/models/sphere.ply --strokes '" +
                                        path("work.inkml") + "' --atlas-size " + size);
    EXPECT_EQ(painted["strokes"].size(), 3u);
    EXPECT_EQ(painted["canvas_hash"], test::stored_hash(path("work.tuft")));
    const int valid = std::system(("bash '" + source_folder() + "/tests/io/validate_glb.sh' '" + source_folder() +
                                   "/build/node' '" + path("work.glb") + "' >'" + path("valid") + "' 2>&1")
                                      .c_str());
    if (WEXITSTATUS(valid) == 77)
        std::puts("the glTF validator is not installed: the exported file is not checked");
    else
        EXPECT_EQ(valid, 0) << read("valid");
}

// The spacenav daemon, played by the test, turns the model; its device is pulled out; the hand paints on.
TEST_F(Window, ASpaceMouseTurnsTheModelAndMayBePulledOut) {
    test::SpaceDaemon daemon(path("spnav"));
    setenv("SPNAV_SOCKET", path("spnav").c_str(), 1);
    std::ofstream(path("script"))
        << "open " + source_folder() +
               "/models/bowl.ply\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\n"
               "report\nscreenshot "
        << path("ready.png")
        << "\nawait message unplugged\nreport\n"
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
