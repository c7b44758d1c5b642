#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "ink/colour/pigments.h"
#include "ink/composite/composite.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/project.h"
#include "mesh/query/surface_query.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/tables.h"
#include "studio_program.h"

/// The real program, played by scripts without a display.
namespace tuft::app {
namespace {

// All by the mouse, in a window high enough for the whole column of tools.
TEST_F(StudioProgram, LayersAreCopiedBlendedRenamedMergedAndDraggedInTheirList) {
    const Ran ran =
        studio(kBowl +
                   "stroke 46%,58% 50%,61% 54%,58%\nclick \"Add a layer\"\nwait-ready\nset layer \"Layer 2\"\nset ink "
                   "cinnabar\n"
                   "stroke 46%,56% 50%,63% 54%,56%\nwait-ready\nexpect label \"layer Layer 2\"\n"
                   "click \"layer Layer 1\"\nwait 0.1\nclick \"layer Layer 2\"\nwait 0.1\nclick "
                   "Duplicate\nwait-ready\nexpect label \"layer Layer 2 copy\"\n"
                   "click Multiply\nwait-ready\n"
                   "key f2\nwait 0.1\ntype gold\nkey enter\nwait-ready\nexpect label \"layer gold\"\n"
                   "click \"layer Layer 2\"\nwait 0.1\nclick \"Merge down\"\nwait-ready\n"
                   "move \"layer gold\"\npress\nwait 0.1\nmove \"layer Layer 1\"\nwait 0.1\nrelease\nwait-ready\n"
                   "save work.tuft\nwait-ready\n",
               "--headless --size 1280x1500");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json project = tuft("inspect '" + path("work.tuft") + "' --json");
    ASSERT_EQ(project["layers"].size(), 2u);
    EXPECT_EQ(project["layers"][0]["name"], "gold");
    EXPECT_EQ(project["layers"][0]["blend"], "multiply");
    tuft("replay '" + path("work.tuft") + "' --json");
}

// A colour chosen by its code is mixed from the pigments, painted with, and part of the project.
TEST_F(StudioProgram, AChosenColourIsMixedAndPaintedWith) {
    const Ran ran = studio(kBowl +
                               "move Colour...\nwait 0.2\nplaces\nreport\nclick Colour...\nwait-ready\nexpect label "
                               "Hex\nplaces\nreport\nset colour "
                               "\"#603010\"\nwait-ready\nstroke 46%,58% 50%,61% 54%,58%\n"
                               "wait-ready\nexpect strokes 1\nsave work.tuft\nwait-ready\n",
                           "--headless --size 1280x900");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json project = tuft("inspect '" + path("work.tuft") + "' --json");
    EXPECT_EQ(project["strokes"][0]["ink"], "#603010");
    const std::string recent = read(path("state") + "/tuft/colours");
    EXPECT_EQ(recent, "#603010\n");
    // A hint goes with the press, so that it hides nothing of the panel that opens beside it.
    const auto seen = places_in_turn(ran.out);
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_TRUE(seen[0].contains("hint"));
    EXPECT_FALSE(seen[1].contains("hint"));
}

// The brush fits the model, and a person's choice is there the next time.
TEST_F(StudioProgram, TheBrushOfAModelIsRemembered) {
    ASSERT_EQ(studio(kBowl + "set brush goat-small\nstroke 46%,58% 50%,61% 54%,58%\nwait-ready\n").status, 0);
    const Ran ran = studio(kBowl + "stroke 46%,58% 50%,61% 54%,58%\nwait-ready\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(tuft("inspect '" + path("work.tuft") + "' --json")["strokes"][0]["brush"], "goat-small");
}

TEST_F(StudioProgram, PaintsToTheBitWhatAReplayPaints) {
    const Ran ran = studio(
        kBowl + kTwoStrokes +
        "stroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 3\nundo\nwait-ready\nexpect strokes 2\nredo\nwait-ready\n"
        "expect strokes 3\nundo\nundo\nredo\nwait-ready\nexpect strokes 2\nsave work.tuft\nexport "
        "work.glb\nwait-ready\n"
        "expect kept\nexpect message Exported\nscreenshot work.png\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json replayed = tuft("replay '" + path("work.tuft") + "'");
    EXPECT_EQ(replayed["strokes"], 2);
    EXPECT_EQ(replayed["canvas_hash"], test::stored_hash(path("work.tuft")));
    EXPECT_NE(replayed["canvas_hash"], "0000000000000000");
    EXPECT_EQ(io::read_model(path("work.glb")).n_polygons(),
              io::Project::open(path("work.tuft")).model().mesh.n_triangles());
    EXPECT_GT(fs::file_size(path("work.png")), 10'000u);
    for (const auto& left : fs::directory_iterator(path("state") + "/tuft/sessions"))
        EXPECT_NE(left.path().extension(), ".tuft") << "the file of the work before it had a name";
}

TEST_F(StudioProgram, TheProjectsPictureShowsTheNewestInkHoweverSoonOneLeaves) {
    const Ran ran = studio(kBowl + "save work.tuft\nwait-ready\n" + kTwoStrokes);
    ASSERT_EQ(ran.status, 0) << ran.err;
    int pictures = 0, red = 0;
    for (const auto& file : fs::directory_iterator(path("state") + "/tuft/pictures")) {
        const io::Image8 image = io::read_image8(file.path(), std::size_t{1} << 22);
        ++pictures;
        for (std::size_t i = 0; i + 2 < image.pixels.size(); i += static_cast<std::size_t>(image.channels))
            red += image.pixels[i] > image.pixels[i + 1] + 60;
    }
    EXPECT_EQ(pictures, 1);
    EXPECT_GT(red, 20);  // of the second stroke; the bowl and its ground are grey
}

TEST_F(StudioProgram, SymmetricCopiesAreStrokesOfTheirOwnAndUndoneTogether) {
    const Ran ran =
        studio(kBowl +
               "set radial 3\nset mirror x\nstroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 6\n"
               "undo\nwait-ready\nexpect strokes 0\nredo\nwait-ready\nexpect strokes 6\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

// The buttons, which are grey where nothing can be undone or redone; keys would reach the painter all the same.
TEST_F(StudioProgram, TheFirstStrokeCanBeUndoneByItsButtonAndANewOneLeavesNothingToRedo) {
    const Ran ran =
        studio(kBowl +
               "stroke 46%,58% 50%,61%\nwait-ready\nclick Undo\nwait-ready\nexpect strokes 0\n"
               "stroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 1\nclick Redo\nwait-ready\nexpect strokes 1\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(StudioProgram, AJournalThatWasChangedReplaysToTheSameTexels) {
    const Ran ran = studio(
        kBowl + kTwoStrokes +
        "stroke 50%,59% 53%,57%\nwait-ready\nclick \"stroke 2\"\nclick Hide\nwait-ready\nclick Show\nwait-ready\n"
        "click \"Change ink\"\nwait 0.3\nclick indigo\nwait-ready\nclick \"stroke 2\"\nclick \"stroke 1\"\nclick "
        "Delete\nwait-ready\n"
        "expect strokes 2\nexpect kept\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 2u);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, AChangeOfTheJournalIsUndoneLikeAStroke) {
    // Work goes on in the file that was saved last.
    const auto keep = [](const std::string& name) {
        return "wait-ready\nsave " + name + ".tuft\nwait-ready\nsave work.tuft\nwait-ready\n";
    };
    const Ran ran =
        studio(kBowl + kTwoStrokes + "stroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 3\n" + keep("before") +
               "click \"stroke 2\"\nclick Delete\nwait-ready\nexpect strokes 2\nundo\nwait-ready\nexpect strokes 3\n" +
               keep("undone") +
               // The stroke after the change can be taken back and forth over it.
               "redo\nwait-ready\nexpect strokes 2\nundo\nundo\nwait-ready\nexpect strokes 2\nredo\nwait-ready\nexpect "
               "strokes 3\nredo\nwait-ready\nexpect strokes 2\n" +
               keep("redone") +
               "undo\nwait-ready\nclick \"stroke 1\"\nclick Hide\nwait-ready\nundo\nwait-ready\nexpect kept\n" +
               keep("shown"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto hash = [this](const std::string& project) { return test::stored_hash(path(project)); };
    EXPECT_EQ(hash("undone.tuft"), hash("before.tuft"));
    EXPECT_EQ(hash("shown.tuft"), hash("before.tuft"));
    EXPECT_NE(hash("redone.tuft"), hash("before.tuft"));
    const auto before = io::Project::open(path("before.tuft")).strokes(),
               undone = io::Project::open(path("undone.tuft")).strokes(),
               redone = io::Project::open(path("redone.tuft")).strokes();
    ASSERT_EQ(undone.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(undone[i].id, before[i].id);
    ASSERT_EQ(redone.size(), 2u);
    EXPECT_EQ(redone[1].id, before[2].id);
    for (const char* project : {"undone.tuft", "redone.tuft", "shown.tuft"})
        EXPECT_EQ(tuft("replay '" + path(project) + "'")["canvas_hash"], hash(project)) << project;
}

TEST_F(StudioProgram, ALineFollowsItsControlPointsAndIsUndoneAsOne) {
    const Ran ran =
        studio(kBowl +
               "set tool line\nstroke 44%,58% 58%,58%\nwait-ready\nwait 0.1\nexpect strokes 1\n"
               "move 58%,58%\npress\nmove 57%,61%\nmove 56%,62%\nrelease\nwait-ready\nwait 0.1\nexpect strokes 1\n"
               "key c\nmove 45%,57%\npress\nrelease\nmove 50%,61%\npress\nrelease\nmove 54%,57%\npress\nrelease\n"
               "key enter\nwait-ready\nwait 0.1\nexpect strokes 2\nundo\nwait-ready\nexpect strokes 1\nsave "
               "after.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    // Drawn level; its right end was pulled down then.
    const auto strokes = io::Project::open(path("after.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 1u);
    const auto& samples = stroke::samples_of(strokes[0]).samples;
    EXPECT_LT(samples.back().position.z, samples.front().position.z - 3e-3);
    EXPECT_EQ(tuft("replay '" + path("after.tuft") + "'")["canvas_hash"], test::stored_hash(path("after.tuft")));
}

TEST_F(StudioProgram, LinesAndCurvesArePaintedWithTheChosenSettings) {
    const std::string half =
        "set elevation 10\nset zoom 4\nset tool mask\nset mask-kind angle\nset mask-within 90\nmove "
        "50%,58%\npress\nrelease\nwait-ready\nwait 0.1\n";
    const Ran ran =
        studio(kBowl + half +
               "set wet on\nset two-inks on\nset tip-ink cinnabar\nset tool brush\nstroke 42%,40% 50%,43%\nwait-ready\n"
               "key l\nstroke 42%,50% 52%,52%\nwait-ready\nwait 0.1\n"
               "key c\nmove 43%,60%\npress\nrelease\nmove 52%,62%\npress\nrelease\nkey enter\nwait-ready\nwait 0.1\n"
               "save all.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("all.tuft")).strokes();
    // The mask, then the brush dipped, wiped and dipped before each of the three.
    ASSERT_EQ(strokes.size(), 13u);
    for (std::size_t i = 5; i < strokes.size(); ++i) {
        const stroke::JournalEntry &by_hand = strokes[1 + (i - 1) % 4], &other = strokes[i];
        EXPECT_EQ(stroke::kind_of(other), stroke::kind_of(by_hand)) << i;
        EXPECT_EQ(stroke::ink_of(other), stroke::ink_of(by_hand)) << i;
        EXPECT_EQ(stroke::brush_of(other), stroke::brush_of(by_hand)) << i;
        EXPECT_EQ(stroke::entry_json(other), stroke::entry_json(by_hand)) << i;
    }
    EXPECT_EQ(stroke::mask_of(strokes.back()), strokes.front().get<stroke::MaskEdit>().mask.id);
    EXPECT_EQ(strokes.back().get<stroke::PaintStroke>().settings.film, stroke::FilmModel::wet);
}

// The release comes when there is no model: the next one is painted on as the first was.
TEST_F(StudioProgram, AModelClosedUnderAStrokeLeavesNoStrokeBehind) {
    const Ran ran = studio(kBowl + "move 46%,50%\npress\nmove 50%,52%\nclose\nrelease\nwait-ready 20\n" + kBowl +
                           "stroke 46%,50% 54%,50%\nwait-ready\nexpect strokes 1\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

// What is held on the keyboard turns the wheel and the buttons to other uses, in either keymap.
TEST_F(StudioProgram, HeldKeysRollPanAndZoom) {
    const std::string drag = "move 55%,55%\npress middle\nmove 60%,50%\nrelease middle\nwait-ready\nreport\n";
    const Ran ran = studio(kBowl + "report\n" + "hold shift\n" + drag + "hold ctrl\n" + drag + "hold none\n" + drag +
                           "set keymap maya\nmove 55%,55%\nhold alt\npress\nmove 60%,50%\nrelease\nhold "
                           "none\nwait-ready\nreport\nexpect strokes 0\n" +
                           "hold ctrl\nscroll 3\nhold none\nwait-ready\nreport\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::istringstream lines(ran.out);
    std::vector<nlohmann::json> views;
    for (std::string line; std::getline(lines, line);) views.push_back(nlohmann::json::parse(line));
    ASSERT_EQ(views.size(), 6u);
    const auto changed = [&](std::size_t i, const char* key) { return views[i][key] != views[i - 1][key]; };
    // Of moved, nearer, turned, turned as in Maya, rolled.
    const bool wanted[5][4] = {{false, false, false, true},
                               {false, true, false, false},
                               {true, false, false, false},
                               {true, false, false, false},
                               {false, false, true, false}};
    for (std::size_t i = 1; i < 6; ++i) {
        EXPECT_EQ(changed(i, "azimuth_deg"), wanted[i - 1][0]) << i;
        EXPECT_EQ(changed(i, "distance_mm"), wanted[i - 1][1]) << i;
        EXPECT_EQ(changed(i, "roll_deg"), wanted[i - 1][2]) << i;
        EXPECT_EQ(changed(i, "target_mm"), wanted[i - 1][3]) << i;
    }
}

TEST_F(StudioProgram, AStrokeMovedInTheMiddleReplaysToTheSameTexels) {
    const Ran ran = studio(kBowl + kTwoStrokes +
                           "click \"stroke 1\"\nwait 0.1\nclick Move\nmove 50%,59%\npress\nmove 52%,57%\nmove "
                           "54%,56%\nrelease\nwait-ready\n"
                           "expect strokes 2\nexpect kept\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 2u);
    EXPECT_EQ(strokes[0].id, 1u);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, ARevisedModelGetsTheStrokesAndNamesThoseThatDoNotFit) {
    const Ran ran = studio(kBowl + kTwoStrokes + "save work.tuft\nwait-ready\nrevise " + source_folder() +
                           "/models/torus.ply\nwait-ready\nset texels 512\n"
                           "click \"Unwrap and repaint\"\nwait-ready\nexpect model\nexpect strokes 2\nwait 0.2\nnames\n"
                           "save revised.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json truth = tuft("replay '" + path("revised.tuft") + "'");
    EXPECT_EQ(truth["canvas_hash"], test::stored_hash(path("revised.tuft")));
    // The dialog is there exactly when a replay on that model finds a stroke that does not fit it.
    const nlohmann::json revised =
        tuft("replay '" + path("work.tuft") + "' --model " + source_folder() + "/models/torus.ply --atlas-size 512");
    EXPECT_EQ(ran.out.find("Keep them") != std::string::npos, !revised["mismatches"].empty()) << revised.dump();
    EXPECT_EQ(io::Project::open(path("work.tuft")).strokes().size(), 2u);
}

TEST_F(StudioProgram, LostGraphicsAreMadeAnewWithAllTheirInk) {
    const Ran ran =
        studio(kBowl + kTwoStrokes +
                   "wait 0.1\nmove 5%,5%\nwait 0.1\nscreenshot before.png\nlose-graphics\nwait 0.1\nexpect "
                   "message graphics\nwait-ready\nwait 0.1\n"
                   "screenshot after.png\nstroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 3\nexpect kept\n",
               "--headless --size 1280x720");  // where the line is long enough for the message
    ASSERT_EQ(ran.status, 0) << ran.err;
    const io::Image8 before = io::read_image8(path("before.png"), 1 << 24),
                     after = io::read_image8(path("after.png"), 1 << 24);
    ASSERT_EQ(before.pixels.size(), after.pixels.size());
    // All but the status line at the bottom, which tells what happened.
    const std::size_t same = before.pixels.size() - static_cast<std::size_t>(before.channels * before.width) * 30;
    EXPECT_TRUE(std::equal(before.pixels.begin(), before.pixels.begin() + static_cast<std::ptrdiff_t>(same),
                           after.pixels.begin()));
}

TEST_F(StudioProgram, KeysCanBeChangedAndStayChanged) {
    const Ran ran = studio(kBowl + "key f1\nwait 0.1\nclick \"key open\"\nkey k\nwait 0.1\nkey escape\nwait 0.1\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(read(path("state") + "/tuft/settings").find("key:open K"), std::string::npos);
}

TEST_F(StudioProgram, LayersArePaintedHiddenAndUndoneLikeStrokes) {
    const Ran ran = studio(
        kBowl +
        "set wet on\nset persistent on\nstroke 46%,58% 50%,61%\nwait-ready\nclick \"Add a layer\"\nwait-ready\nwait "
        "0.1\nset layer \"Layer 2\"\nset ink cinnabar\n"
        "stroke 44%,57% 47%,60%\nwait-ready\nexpect strokes 3\nclick \"show Layer 2\"\nwait-ready\nexpect "
        "strokes 4\nundo\nundo\nredo\nwait-ready\n"
        "expect strokes 3\nset shading wetness\nwait-ready\nset shading glaze\nexpect kept\nsave "
        "work.tuft\nwait-ready\nsave more.tuft\nwait-ready\nset ink carbon\nset tip-ink gamboge\nset two-inks "
        "on\nset mirror x\n"
        "stroke 52%,57% 56%,60%\nwait-ready\nexport more.inkml\nwait-ready\nexpect message Exported\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 3u);
    EXPECT_EQ(stroke::layer_of(strokes[0]), stroke::kFirstLayer);
    EXPECT_NE(stroke::layer_of(strokes[2]), stroke::kFirstLayer);
    // The exported strokes paint the same, on both layers, with what was done with the brush between them.
    const nlohmann::json painted =
        tuft("paint " + source_folder() + "/models/bowl.ply --strokes '" + path("more.inkml") + "' --atlas-size 512");
    EXPECT_EQ(painted["strokes"].size(), 4u);
    EXPECT_EQ(painted["canvas_hash"], tuft("replay '" + path("more.tuft") + "'")["canvas_hash"]);
    tuft("export '" + path("more.tuft") + "' -o '" + path("again.inkml") + "'");
    EXPECT_EQ(read(path("again.inkml")), read(path("more.inkml")));
}

TEST_F(StudioProgram, AMixturePickedUpIsAnInkOfTheProject) {
    const Ran ran = studio(kBowl +
                           "set ink gamboge\nset tip-ink cinnabar\nset two-inks on\nset pressure 0.8\nstroke 44%,54% "
                           "47%,62% 52%,64%\nwait-ready\nexpect strokes 4\n"
                           "undo\nwait-ready\nexpect strokes 0\nredo\nwait-ready\nexpect strokes 4\nset tool "
                           "pick\nmove 47%,62%\npress\nrelease\nwait-ready\nwait 0.1\n"
                           "expect message mixture\nset two-inks off\nset wet on\nstroke 55%,57% "
                           "60%,58%\nwait-ready\nsave work.tuft\nwait-ready\nexpect kept\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const io::Project project = io::Project::open(path("work.tuft"));
    const auto strokes = project.strokes();
    ASSERT_EQ(strokes.size(), 5u);
    EXPECT_EQ(stroke::kind_of(strokes[1]), stroke::EntryKind::wipe);
    EXPECT_EQ(stroke::ink_of(strokes[2]), "cinnabar");
    EXPECT_EQ(stroke::ink_of(strokes[4]), "mixture");
    EXPECT_EQ(strokes[4].get<stroke::PaintStroke>().settings.film, stroke::FilmModel::wet);
    for (const auto& [name, toml] : project.inks())
        if (name == "mixture") {
            EXPECT_EQ(ink::parse_ink(toml, name).parts.size(), 2u);
        }
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, ABrushDippedOnOneSideReplays) {
    const Ran ran =
        studio(kBowl +
                   "set ink gamboge\nset pressure 0.8\nset persistent on\nwait 0.1\nset dip-side 0.5\nclick "
                   "Wipe\nwait-ready\nset ink cinnabar\nclick Dip\nwait-ready\n"
                   "expect strokes 2\nstroke 44%,52% 47%,60% 52%,62%\nwait-ready\nsave work.tuft\nwait-ready\n",
               "--headless --size 1280x1400");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_GE(strokes.size(), 3u);  // a path that leaves the bowl makes two strokes
    EXPECT_EQ(stroke::kind_of(strokes[0]), stroke::EntryKind::wipe);
    EXPECT_EQ(stroke::kind_of(strokes[1]), stroke::EntryKind::dip);
    EXPECT_EQ(std::get<stroke::Wipe>(strokes[0].get<stroke::BrushAction>().what).side, 0.5);
    EXPECT_EQ(std::get<stroke::Dip>(strokes[1].get<stroke::BrushAction>().what).side, 0.5);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, InksMixOnThePaletteAndTheMixtureReplays) {
    const Ran ran = studio(
        kBowl +
        "set palette on\nwait 0.1\nset palette-tool pour\nset ink cinnabar\nmove 398,150\npress\nrelease\nwait-ready\n"
        "set ink gamboge\nmove 468,150\npress\nrelease\nwait-ready\nset palette-tool brush\nclick \"Rinse the "
        "brush\"\nwait-ready\n"
        "stroke 383,150 483,150 388,155\nwait-ready\nexpect strokes 4\nset palette off\nset wet on\nstroke 52%,60% "
        "57%,61%\nwait-ready\nexpect strokes 5\n"
        "undo\nwait-ready\nundo\nwait-ready\nexpect strokes 3\nredo\nredo\nwait-ready\nexpect strokes 5\nexpect "
        "kept\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 5u);
    EXPECT_EQ(stroke::layer_of(strokes[0]), stroke::kPaletteLayer);
    EXPECT_EQ(stroke::kind_of(strokes[2]), stroke::EntryKind::rinse);
    EXPECT_EQ(stroke::layer_of(strokes[3]), stroke::kPaletteLayer);
    EXPECT_EQ(stroke::layer_of(strokes[4]), stroke::kFirstLayer);
    EXPECT_EQ(stroke::ink_of(strokes[4]), stroke::ink_of(strokes[3])) << "the brush was not dipped anew";
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, StrokesKeepToAMaskDrawnOnTheModel) {
    const std::string lasso =
        "set tool mask\nset mask-kind lasso\nmove 49%,50%\npress\nmove 60%,50%\nmove 60%,66%\nmove "
        "49%,66%\nrelease\nwait-ready\nwait 0.1\nset tool brush\n";
    const std::string crossing = "stroke 44%,58% 55%,59%\nwait-ready\n";
    const Ran ran =
        studio(kBowl + lasso + "expect strokes 1\n" + crossing + "expect strokes 2\nsave masked.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = io::Project::open(path("masked.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 2u);
    EXPECT_EQ(strokes[0].get<stroke::MaskEdit>().mask.kind, stroke::MaskKind::lasso);
    EXPECT_EQ(stroke::mask_of(strokes[1]), strokes[0].get<stroke::MaskEdit>().mask.id);
    // Ink lies where the lasso is, and none at the stroke's start outside it.
    const auto& samples = stroke::samples_of(strokes[1]).samples;
    const mesh::TriangleMesh mesh = io::Project::open(path("masked.tuft")).model().mesh;
    const mesh::SurfaceQuery surface(mesh);
    const auto pigments_at = [&](const stroke::StrokeSample& s) {
        const Vec3 p = 1e3 * surface.closest_point(s.position)->position;  // below the ferrule
        char text[120];
        std::snprintf(text, sizeof text, "inspect '%s' --at %.4f,%.4f,%.4f", path("masked.tuft").c_str(), p.x, p.y,
                      p.z);
        return tuft(text)["films"].size();
    };
    EXPECT_EQ(pigments_at(samples.front()), 0u);
    std::size_t painted = 0;  // a single texel may lie between the hairs
    for (const std::size_t tenth : {6, 7, 8}) painted += pigments_at(samples[samples.size() * tenth / 10]);
    EXPECT_GT(painted, 0u);
    EXPECT_EQ(tuft("replay '" + path("masked.tuft") + "'")["canvas_hash"], test::stored_hash(path("masked.tuft")));
}

TEST_F(StudioProgram, RecolouringKeepsAllAmountsAndIsThereAgainNextTime) {
    const Ran ran =
        studio(kBowl + kTwoStrokes +
               "click Edit\nwait 0.1\nclick \"Recolour...\"\nwait 0.1\nclick \"As cinnabar\"\nwait 0.1\nclick "
               "indigo\nwait-ready\n"
               "click \"Shown on\"\nwait 0.1\nclick bisque\nwait-ready\nexpect kept\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const io::Project project = io::Project::open(path("work.tuft"));
    ASSERT_EQ(project.recolours().size(), 1u);
    EXPECT_EQ(project.recolours()[0].first, "cinnabar");
    EXPECT_EQ(ink::parse_ink(project.recolours()[0].second, "").name, "indigo");
    EXPECT_EQ(ink::parse_substrate(project.shown_substrate(), "").name, "bisque");
    EXPECT_EQ(ink::parse_substrate(project.model().substrate, "").name, "porcelain");
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

// A hand at a thousand samples a second while all processors are busy: every sample is a pose of the stroke
// that is kept.
TEST_F(StudioProgram, NoSampleOfTheHandIsLostUnderLoad) {
    std::atomic<bool> stop{false};
    std::vector<std::thread> load;
    for (unsigned i = 0; i < std::max(2u, std::thread::hardware_concurrency()); ++i)
        load.emplace_back([this, &stop] {
            while (!stop && !fs::exists(path("ready.png"))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
            while (!stop) {
            }
        });
    const Ran ran = studio(kBowl +
                               "screenshot ready.png\npace on\nrate 1000\nset clean-ends off\nstroke 42%,57% "
                               "56%,60%,0.8 44%,61% 57%,57%\nwait-ready\nexpect strokes 1\nreport\n"
                               "save work.tuft\nwait-ready\n",
                           "--headless --size 1280x720");
    stop = true;
    for (std::thread& thread : load) thread.join();
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto samples = io::Project::open(path("work.tuft")).strokes().at(0).get<stroke::PaintStroke>().trace.samples;
    EXPECT_GT(samples.size(),
              1000u);  // three paths of some 100 pixels at 260 pixels a second, a sample each millisecond
    // Each sample went to the painter as a pose; the last one is the lift, which is drawn in twelve.
    EXPECT_EQ(samples.size(), nlohmann::json::parse(ran.out)["samples"].get<std::size_t>() - 1 + 12);
    for (std::size_t i = 2; i + 13 < samples.size(); ++i)
        EXPECT_NEAR(samples[i].time - samples[i - 1].time, 1e-3, 1e-9) << i;
}

TEST_F(StudioProgram, AKillLosesNoFinishedStroke) {
    const std::string script =
        kBowl + kTwoStrokes + "screenshot ready.png\nmove 47%,58%\npress\nmove 50%,59%\nwait 100\n";
    const std::string line = command(script, "--headless --size 884x520");
    const pid_t child = fork();
    if (child == 0) {
        execl("/bin/bash", "bash", "-c", line.c_str(), nullptr);
        _exit(127);
    }
    for (int i = 0; i < 600 && !fs::exists(path("ready.png")); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ASSERT_TRUE(fs::exists(path("ready.png"))) << read(path(".err"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const Ran again = studio(
        "wait 0.2\nexpect label Continue\nclick Continue\nwait 0.2\nwait-ready\nexpect strokes 2\n"
        "stroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 3\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
    // Saved under a name: nothing is offered any more.
    const Ran third = studio("wait 0.4\nnames\n");
    EXPECT_NE(third.out.find("Open..."), std::string::npos) << third.err;
    EXPECT_EQ(third.out.find("Continue"), std::string::npos);
}

// A model or project that it opened in place of the bowl is a project of its own.
TEST_F(StudioProgram, RandomEventsNeitherCrashItNorLoseAStroke) {
    const Ran ran = studio(kBowl + "set draw-every 80\nrandom 5000 4\nwait-ready\nreport\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = nlohmann::json::parse(ran.out)["strokes"].get<std::size_t>();
    std::size_t all = 0;
    bool kept = strokes == 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
        if (entry.path().extension() != ".tuft") continue;
        const std::size_t n = io::Project::open(entry.path()).strokes().size();
        all += n;
        kept = kept || n == strokes;
        if (n > 0) {
            EXPECT_EQ(tuft("replay '" + entry.path().string() + "'")["canvas_hash"], test::stored_hash(entry.path()))
                << entry.path();
        }
    }
    EXPECT_TRUE(kept) << strokes;
    EXPECT_GT(all, 10u);
}

TEST_F(StudioProgram, BadFilesAndFoldersAreAMessageAndWorkGoesOn) {
    std::ofstream(path("bad.ply")) << "ply\nformat ascii 1.0\nelement vertex 5\nend_header\n";
    std::ofstream(path("bad.tuft")) << "not a project";
    const Ran ran = studio(
        "open bad.ply\nwait-ready\nexpect no-model\nexpect message bad.ply\nopen missing.obj\nwait-ready\nexpect "
        "message missing.obj\n"
        "open bad.tuft\nwait-ready\nexpect message bad.tuft\n" +
        kBowl +
        "open bad.ply\nwait-ready\nexpect model\nsave /no/such/folder/x.tuft\nwait-ready\nexpect message /no/such\n"
        "stroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 1\nexpect kept\nexport out.xyz\nwait-ready\nexpect message "
        "out.xyz\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

// Strokes are asked for without a wait, as a quick hand does.
TEST_F(StudioProgram, ALayerJustAddedIsPaintedOnAndAfterItsEndTheOneBefore) {
    const std::string add = "click \"Add a layer\"\n", stroke = "stroke 46%,58% 50%,61%\n",
                      undo = "wait-ready\nundo\nwait-ready\nwait 0.2\n";
    const Ran ran = studio(kBowl + stroke + add + stroke +                             // on layers 1, 2
                           "wait-ready\nwait 0.2\nset layer \"Layer 1\"\n" + stroke +  // 1
                           add + "wait-ready\nwait 0.2\n" + add + stroke +             // 4
                           undo + undo + undo + stroke +                               // without them: 1
                           "wait-ready\nclick \"layer Layer 2\"\nwait 0.3\nclick Remove\nwait-ready\nwait 0.2\n" +
                           stroke + undo + undo + stroke +  // it is back: 2
                           "wait-ready\nset palette on\n" + add + "wait-ready\nset palette off\n" + stroke +  // 3
                           "wait-ready\nexpect kept\nsave work.tuft\nwait-ready\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto entries = io::Project::open(path("work.tuft")).strokes();
    const stroke::LayerTable table = stroke::layers_after(entries);
    std::string layers;
    for (const stroke::JournalEntry& s : entries)
        if (s.as<stroke::PaintStroke>()) layers += table.find(stroke::layer_of(s))->name.substr(6);
    EXPECT_EQ(layers, "12112" + std::to_string(table.layers.size()));
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

// Neither the state folder nor a temporary one can be written into.
TEST_F(StudioProgram, WorkGoesOnWhereNothingCanBeKeptAndCanBeSavedElsewhere) {
    fs::remove_all(path("state"));
    std::ofstream(path("state")) << "a file, no folder";
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    setenv("TMPDIR", "/proc", 1);
    const Ran ran = studio(
        kBowl + kTwoStrokes +
        "expect message tuft\nundo\nwait-ready\nexpect strokes 1\nsave work.tuft\nwait-ready\nwait 0.1\nexpect kept\n"
        "stroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 2\nexpect kept\n");
    if (before)
        setenv("TMPDIR", kept.c_str(), 1);
    else
        unsetenv("TMPDIR");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(io::Project::open(path("work.tuft")).strokes().size(), 2u);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioProgram, AboutNamesTheVersionAndIsClosed) {
    const Ran ran =
        studio("click Help\nclick \"About tuft studio\"\nawait label Copy\nclick Copy\nclick Close\nwait 0.2\nnames\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out.find("Copy"), std::string::npos) << ran.out;
    EXPECT_EQ(studio("quit\n", "--version --headless").out.find("tuft-studio "), 0u);
}

TEST_F(StudioProgram, WrongUseIsOneLineAndStatusTwo) {
    for (const std::string options : {"--frobnicate", "--size banana", "a.ply b.ply"}) {
        const Ran ran = studio("quit\n", options);
        EXPECT_EQ(ran.status, 2) << options;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    }
    const Ran ran = studio("expect model\n");
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("script.txt:1: no model is open"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace tuft::app
