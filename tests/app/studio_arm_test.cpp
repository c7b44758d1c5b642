#include <atomic>
#include <chrono>
#include <thread>

#include "served.h"
#include "studio_program.h"

/// The force-feedback arm in the real program: a simulated arm in a simulated hand, a service, a recording.
namespace tuft::app {
namespace {

class StudioArm : public StudioProgram {
  protected:
    void expect_played(const std::string& script) {
        const Ran ran = studio(script);
        ASSERT_EQ(ran.status, 0) << ran.err;
    }
    // Strokes of the project, whose journal gives the texels that were painted, to the bit.
    int strokes_that_replay(const std::string& project) {
        const nlohmann::json replayed = tuft("replay '" + path(project) + "'");
        EXPECT_EQ(replayed["canvas_hash"], test::stored_hash(path(project)));
        EXPECT_NE(replayed["canvas_hash"], "0000000000000000");
        return replayed["strokes"];
    }
};

const std::string kLookedAt =
    kBowl + "set brush wolf-medium\nset azimuth 20\nset elevation 60\nsave work.tuft\nwait 0.2\n";
const std::string kDrags = kLookedAt + "set arm-hand drag\nset arm on\nawait arm painting\nwait 0.5\n";

TEST_F(StudioArm, PaintsAsAPenOnItsLayerAndUnderUndoAndReplaysToTheBit) {
    expect_played(kLookedAt +
                  "click \"Add a layer\"\nwait-ready\nexpect strokes 1\nset arm-hand drag\nset arm on\nawait arm "
                  "painting\nawait force 0.05\nwait 1\nset arm off\nwait-ready\nexpect strokes "
                  "2\nundo\nwait-ready\nexpect strokes 1\nredo\nwait-ready\nexpect strokes 2\nwait 0.2\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 1);
    EXPECT_EQ(tuft("inspect '" + path("work.tuft") + "' --json")["strokes"][1]["layer"], 2);
}

TEST_F(StudioArm, SymmetryAndEraserAreTheArmsToo) {
    expect_played(kLookedAt +
                  "set radial 3\nset arm-hand drag\nset arm on\nawait arm painting\nwait 0.6\nset arm "
                  "off\nwait-ready\nexpect strokes 3\nset radial 1\nset tool eraser\nset arm on\nawait arm "
                  "painting\nwait 0.5\nset arm off\nwait-ready\nexpect strokes 4\nwait 0.2\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 4);
}

// No force leaves without the focus, in a pause, while a dialog is open, or once the key was pressed; ink stays.
TEST_F(StudioArm, FocusPauseDialogAndKeyEndForceAndStrokeButKeepTheInk) {
    expect_played(kDrags +
                  "unfocus\nawait arm free\nawait strokes 1\nfocus\nawait arm painting\nset arm-pause on\nawait arm "
                  "free\nawait strokes 2\nkey f1\nwait 0.1\nset arm-pause off\nwait 0.3\nexpect arm free\nkey f1\n"
                  "await arm painting\nkey space\nawait arm stopped\nawait strokes 3\nwait 0.5\nexpect arm "
                  "stopped\nset arm-emergency off\nawait arm painting\nset arm off\nwait-ready\nexpect strokes "
                  "4\nwait 0.2\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 4);
}

TEST_F(StudioArm, EndingTheProgramInMidStrokeKeepsTheStroke) {
    expect_played(kDrags + "expect arm painting\nquit\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 1);
}

TEST_F(StudioArm, EscapeDropsTheStrokeOfTheArm) {
    expect_played(kDrags + "key escape\nwait 0.3\nset arm off\nwait-ready\nexpect strokes 0\n");
}

// The hand of a simulated arm follows the pointer: hover, press, along a line, lift.
TEST_F(StudioArm, APointerIsTheHandOfASimulatedArm) {
    expect_played(kLookedAt +
                  "set arm on\nawait arm engaged\npace on\nmove 45%,58%\nwait 0.4\nexpect strokes 0\nstroke 45%,58% "
                  "50%,62% 55%,58%\nmove 55%,50%\nawait strokes 1\nawait arm engaged\nset arm off\nwait-ready\nwait "
                  "0.2\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 1);
}

// Another brush, another scale and the clutch leave the arm where it is; the view may turn under the brush.
TEST_F(StudioArm, BrushScaleClutchAndViewChangeWhileItIsFelt) {
    expect_played(kDrags +
                  "set azimuth 40\nwait 0.3\nexpect arm painting\nset arm-clutch on\nawait arm free\nawait strokes "
                  "1\nset brush wolf-small\nwait 0.3\nset arm-clutch off\nset arm-scale 0.5\nwait 1\nset arm-view "
                  "off\nwait 1\nset arm-scale 1\nset arm off\nwait-ready\nwait 0.2\n");
    EXPECT_GE(strokes_that_replay("work.tuft"), 1);
}

TEST_F(StudioArm, StirsOnThePalette) {
    expect_played(kLookedAt +
                  "set palette on\nset arm-palette on\nset arm-hand circles\nset arm on\nawait arm painting\nwait "
                  "1\nset arm off\nwait-ready\nexpect strokes 1\nwait 0.2\n");
    const nlohmann::json project = tuft("inspect '" + path("work.tuft") + "' --json");
    EXPECT_EQ(project["strokes"].size(), 1u);
}

// The service dies when the window has shown that it paints, however long that took.
TEST_F(StudioArm, AServiceThatDiesLeavesTheStrokeAndOneLine) {
    Served server(tuft_program(), "device simulate --port 0 --motion rest --brush wolf-medium");
    ASSERT_GT(server.port, 0);
    std::atomic<bool> ended = false;
    std::jthread death([&] {
        while (!ended && !fs::exists(path("paints.png"))) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        server.die();
    });
    expect_played(kLookedAt + "set arm-view off\nset arm-source service\nset arm-port " + std::to_string(server.port) +
                  "\nset arm on\nawait arm painting\nawait force 0.05\nscreenshot paints.png\nawait message "
                  "ended\nawait arm free\nwait-ready\nexpect strokes 1\nset arm off\nwait 0.2\n");
    ended = true;
    EXPECT_EQ(strokes_that_replay("work.tuft"), 1);
}

TEST_F(StudioArm, ARecordingPaintsWhatTheArmDid) {
    tuft("device record --simulate inverse3 --model '" + source_folder() +
         "/models/bowl.ply' --brush wolf-medium --motion drag --seconds 2.5 -o '" + path("a.csv") + "'");
    // That it paints is seen by its stroke: a window on a busy machine may have no turn while the recording plays.
    expect_played(kLookedAt + "set arm-source recording\nset arm-recording " + path("a.csv") +
                  "\nset arm on\nawait message \"has ended\"\nwait-ready\nexpect strokes 1\nexpect "
                  "arm off\nwait 0.2\n");
    EXPECT_EQ(strokes_that_replay("work.tuft"), 1);
}

TEST_F(StudioArm, WhatCannotBeOpenedIsOneLine) {
    expect_played(kLookedAt +
                  "set arm-source recording\nset arm-recording none.csv\nset arm on\nexpect arm off\nexpect message "
                  "none.csv\n");
}

// All of the panel is on the screen, in both languages.
TEST_F(StudioArm, ThePanelFitsTheSmallestWindowItIsMadeFor) {
    std::string script = kLookedAt + "set arm-panel on\n";
    for (const char* language : {"english", "chinese"})
        script += "set language " + std::string(language) +
                  "\nwait 0.2\nexpect label Connect\nset arm on\nawait arm engaged\nwait 0.2\nexpect label \"Force "
                  "plot\"\nexpect label \"Lateness plot\"\nexpect label Gain\nexpect label \"Close the arm's "
                  "panel\"\nclick Stop\nawait arm stopped\nclick Release\nawait arm engaged\nclick Disconnect\nawait "
                  "arm off\n";
    const Ran ran = studio(script, "--headless --size 1280x720");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

}  // namespace
}  // namespace tuft::app
