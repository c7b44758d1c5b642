#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

#include "io/project/project.h"
#include "studio_program.h"

/// Panels, dialogs and the menu bar as a person finds them.
namespace tuft::app {
namespace {

class Panels : public StudioProgram {};

// Esc drops a curve first: the panel is still there to go on with it.
TEST_F(Panels, EscPutsPanelsOverTheViewAwayOneByOneWhenThereIsNothingElseToLeave) {
    const Ran ran =
        studio(kBowl +
                   "set palette on\nclick \"All brushes\"\nwait 0.2\nset tool curve\nmove 60%,62%\npress\n"
                   "release\nmove 66%,62%\npress\nrelease\nwait 0.1\nkey escape\nwait 0.2\nexpect label "
                   "\"Brush filter\"\nexpect label Plate\nkey escape\nwait 0.2\nexpect label Plate\nplaces\n"
                   "key escape\nwait 0.2\nexpect strokes 0\nnames\n",
               "--headless --size 1600x900");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_FALSE(places(ran.out).contains("Brush filter"));
    EXPECT_EQ(ran.out.find("\nPlate\n"), std::string::npos);
}

// With all that a stroke can be given: wet ink, another ink in the tip, a tool with settings of its own, a drawing.
TEST_F(Panels, NothingNeededForPaintingScrollsAt1280Times720) {
    std::ofstream(path("two.svg")) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path fill='none' "
                                      "stroke='black' stroke-width='1' d='M1 1 l7 7'/></svg>";
    std::string script = kBowl + "set wet on\nset two-inks on\nset text \xe6\xb0\xb8\nopen " + path("two.svg") +
                         "\nwait-ready\nwait 0.2\n";
    const auto expect = [&](std::initializer_list<const char*> labels) {
        for (const char* label : labels) script += "expect label \"" + std::string(label) + "\"\n";
    };
    const std::string look = "places\nreport\n";
    const auto expect_all = [&](double scale) {
        for (const char* tool : {"brush", "line", "curve", "eraser", "writing", "text"}) {
            const std::string name = tool;
            script += "set tool " + name + "\nwait 0.2\n";
            expect({"Brush", "Mask", "Palette", "goat-small", "wolf-large", "Tuft size", "Pressure", "Stabiliser"});
            if (scale == 1) expect({"fold Symmetry", "fold Look inside", "Undo", "Add a layer"});
            if (name == "line" || name == "curve") expect({"Press down in", "Lift in", "Pace"});
            if (name == "writing") expect({"Writing or drawing...", "Width", "Turn", "Drape", "Wrap", "Mirrored"});
            if (name == "writing" && scale == 1) script += look;
            if (name == "text")
                expect({"Text", "Style", "Own brush", "Across", "Down", "Round", "Curve##direction",
                        "Characters from...", "Snap", "Size", "Spacing", "Turn"});
            if (name == "brush" || name == "eraser") expect({"Speed lightens", "Rest deepens", "Clean ends"});
            if (name != "eraser")
                expect({"carbon", "water", "Colour...", "Wet ink", "1 min", "Dry", "Don't reload",
                        "Another ink in the tip", "Tip ink", "Tip"});
        }
        script += "set tool brush\nset persistent on\nwait 0.2\n";
        expect({"Dip", "Wipe", "Rinse", "Comb", "How deep", "Which side", "Pressure"});
        if (scale == 1) script += look;
        script += "set persistent off\n";
    };
    for (const char* language : {"english", "chinese"})
        for (const double scale : {1.0, 1.25, 1.5}) {
            script += "set language " + std::string(language) + "\nset scale " + std::to_string(scale) + "\n";
            expect_all(scale);
        }
    const Ran ran = studio(script, "--headless --size 1280x720");
    EXPECT_EQ(ran.status, 0) << ran.err;
    const auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 4u);
    for (const std::size_t language : {0, 2}) {
        EXPECT_LT(turns[language].at("In mm").first, turns[language].at("Fold the tools").first - 40)
            << "the handle is outside the panel: the switch, 60 pixels wide, lies inside";
        EXPECT_LT(turns[language + 1].at("fold Look inside").second, 680)
            << "the status bar begins at 690: all of it is on the screen";
    }
}

// In a panel ten rows high. The layer that a stroke goes onto is among the rows that are seen.
TEST_F(Panels, ManyLayersLeaveTheJournalAndTheirButtonInReach) {
    std::string script = kBowl + "stroke 46%,58% 54%,60%\nwait-ready\n";
    for (int i = 0; i < 9; ++i) script += "click \"Add a layer\"\nwait-ready\n";
    const Ran ran = studio(script + "wait 0.2\nexpect label \"layer Layer 10\"\nexpect label \"Add a layer\"\n" +
                               "expect label \"stroke 10\"\nclick \"layer Layer 9\"\nwait 0.2\nexpect label "
                               "Opacity\nexpect label \"Add a layer\"\n",
                           "--headless --size 1280x560");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

// The model stays where it is on the screen when another tool is taken: a handle is at the middle of the view's edge.
TEST_F(Panels, LeaveTheViewItsPlaceWhateverTheTool) {
    std::string script = kBowl;
    for (const char* tool : {"brush", "line", "writing", "fill", "mask"})
        script += "set tool " + std::string(tool) + "\nwait 0.2\nplaces\nreport\n";
    const Ran ran = studio(script, "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 5u);
    std::set<std::pair<double, double>> middles;
    for (const auto& labels : turns) middles.insert(labels.at("Fold the tools"));
    EXPECT_EQ(middles.size(), 1u);
}

TEST_F(Panels, AScrollbarShiftsNoColumn) {
    const std::string look = "wait 0.2\nplaces\nreport\n";
    const Ran ran =
        studio(kBowl + "set wet on\nset persistent on\nresize 1280 500\n" + look + "resize 1280 300\n" + look,
               "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    // In both the tools have as little room as there is a layout for.
    auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 2u);
    auto &high = turns[0], &low = turns[1];
    ASSERT_TRUE(high.contains("Which side"));
    ASSERT_FALSE(low.contains("Which side")) << "it would not scroll";
    for (const char* label : {"goat-small", "wolf-large", "Tuft size", "carbon", "titanium-white"}) {
        ASSERT_TRUE(low.contains(label)) << label;
        EXPECT_EQ(low[label].first, high[label].first) << label;
    }
}

// A way to lay the tools out is chosen for the height; the next frame chooses the same.
TEST_F(Panels, TheToolsKeepTheirLayoutAtEachHeightOfTheWindow) {
    std::string script = kBowl;
    for (int height = 576; height <= 640; height += 16) {
        script += "resize 1000 " + std::to_string(height) + "\nwait 0.1\n";
        for (int frame = 0; frame < 3; ++frame) script += "places\nreport\nwait 0.03\n";
    }
    const Ran ran = studio(script, "--headless --size 1000x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 15u);
    for (std::size_t i = 0; i < turns.size(); i += 3)
        for (const char* label : {"wolf-large", "carbon", "Wet ink"})
            for (const std::size_t later : {i + 1, i + 2})
                EXPECT_EQ(turns[i].at(label), turns[later].at(label)) << label << " at height " << i / 3;
}

// Hex codes say no more than the colours themselves, and a drawing brings many.
TEST_F(Panels, InksNamedByTheirColoursStandInSmallBelowTheOthers) {
    std::ofstream(path("two.svg")) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path fill='#bd3b25' "
                                      "d='M0 0 h4 v9 h-4 z'/><path fill='#1b2f5a' d='M5 0 h4 v9 h-4 z'/></svg>";
    const Ran ran = studio(kBowl + "open " + path("two.svg") +
                               "\nwait-ready\nset writing-width 10\nmove 50%,60%\nwait 0.1\npress\nrelease\n"
                               "wait-ready\nwait 0.2\nplaces\n",
                           "--headless --size 1280x1000");
    ASSERT_EQ(ran.status, 0) << ran.err;
    auto at = places(ran.out);
    for (const char* label : {"#bd3b25", "#1b2f5a", "water", "carbon", "cinnabar", "bone-black"})
        ASSERT_TRUE(at.contains(label)) << label;
    EXPECT_EQ(at["#bd3b25"].second, at["#1b2f5a"].second);
    EXPECT_GT(at["#bd3b25"].second, at["water"].second);
    EXPECT_LT(std::abs(at["#bd3b25"].first - at["#1b2f5a"].first), 0.6 * (at["cinnabar"].first - at["carbon"].first));
}

TEST_F(Panels, WhatIsFoldedStaysFolded) {
    const Ran first = studio(kBowl +
                                 "click \"fold Symmetry\"\nwait 0.1\nexpect label \"Radial copies\"\nclick \"fold "
                                 "Brush\"\nwait 0.1\nclick \"Fold the journal\"\nwait 0.1\n",
                             "--headless --size 1280x720");
    ASSERT_EQ(first.status, 0) << first.err;
    const Ran second = studio(kBowl +
                                  "wait 0.2\nexpect label \"Radial copies\"\nplaces\nkey tab\nwait 0.2\nkey tab\nwait "
                                  "0.2\nexpect label Undo\nexpect label \"Radial copies\"\n",
                              "--headless --size 1280x720");
    ASSERT_EQ(second.status, 0) << second.err;
    const auto found = places(second.out);
    EXPECT_FALSE(found.contains("wolf-large"));
    EXPECT_FALSE(found.contains("Undo"));
}

TEST_F(Panels, AHiddenPanelGivesItsSpaceToTheModel) {
    // The handle of the journal is at the view's right edge.
    const Ran ran =
        studio(kBowl + "wait 0.1\nplaces\nclick \"Fold the journal\"\nclick \"Fold the tools\"\nwait 0.2\nplaces\n",
               "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::size_t half = ran.out.rfind(" Brush\n");
    ASSERT_NE(half, std::string::npos);
    const auto after = places(ran.out.substr(ran.out.size() / 2));
    ASSERT_TRUE(after.contains("Fold the journal"));
    EXPECT_GT(after.at("Fold the journal").first, 1260);
    EXPECT_LT(after.at("Fold the tools").first, 80);
    EXPECT_TRUE(after.contains("Brush")) << "tools stay to be chosen";
}

TEST_F(Panels, EscapeClosesAMenuBeforeItDropsWhatIsChosen) {
    const Ran ran = studio(kBowl + kTwoStrokes +
                               "click \"stroke 2\"\nwait-ready\nwait 0.2\nexpect label Hide\nright-click \"stroke 2\"\n"
                               "wait 0.2\nexpect label Ungroup\nkey escape\nwait 0.2\nplaces\nexpect label Hide\nkey "
                               "escape\nwait 0.2\nplaces\n",
                           "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::size_t half = ran.out.find("\n", ran.out.size() / 2);
    EXPECT_EQ(ran.out.find(" Ungroup\n"), std::string::npos) << "the menu is gone";
    EXPECT_TRUE(places(ran.out.substr(0, half)).contains("Hide"));
    EXPECT_EQ(ran.out.rfind(" Hide\n"), ran.out.find(" Hide\n")) << "then the choice is dropped";
}

TEST_F(Panels, AWideFerruleCanBeRolledAndARoundOneSaysNothingOfIt) {
    const Ran ran = studio(kBowl +
                               "set brush wolf-small\nwait 0.2\nplaces\nset brush flat-12\nwait 0.2\nexpect label "
                               "Roll\nclick \"Follow the stroke\"\nmove 50%,50%\nkey shift+left\nhold alt\nscroll "
                               "2\nhold none\nwait 0.1\n",
                           "--headless --size 1280x720");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_FALSE(places(ran.out).contains("Roll"));
}

// Typed over what is selected: the stem, not the extension.
TEST_F(Panels, SavingAsTakesANewNameByTypingItAndKeepsTheExtension) {
    const Ran ran = studio(kBowl + "key ctrl+s\nwait 0.2\ntype fired\nkey enter\nwait-ready\nexpect kept\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(fs::exists(path("fired.tuft")));
}

TEST_F(Panels, AnErrorWhenSavingKeepsTheNameToBeMended) {
    const std::string mend = "wait 0.2\nexpect label \"file name\"\nkey ctrl+a\ntype ";
    const Ran ran = studio(kBowl + "key ctrl+s\nwait 0.2\nkey ctrl+a\ntype /no/such/folder/x\nkey enter\n" + mend +
                           "/proc/x\nkey enter\nwait-ready\n" + mend + path("mended") +
                           "\nkey enter\nwait-ready\nexpect kept\nexpect message Saved\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(fs::exists(path("mended.tuft")));
}

TEST_F(Panels, TheFileDialogMakesFoldersFiltersSortsAndRemembersWhereOneWas) {
    for (const char* name : {"bowl-one.svg", "bowl-two.svg", "vase.svg"})
        std::ofstream(path(name)) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path fill='none' "
                                     "stroke='black' d='M1 1 l7 7'/></svg>";
    const Ran ran =
        studio(kBowl +
                   "key ctrl+s\nwait 0.2\nclick \"New folder\"\nwait 0.1\nclick \"name of the new folder\"\ntype "
                   "drafts\nkey enter\nwait 0.2\nkey ctrl+a\ntype one\nkey enter\nwait-ready\nexpect kept\n"
                   "set tool writing\nwait 0.1\nclick \"Writing or drawing...\"\nwait 0.2\nexpect label \"folder "
                   "drafts\"\nclick \"file name\"\nkey ctrl+a\ntype " +
                   folder_.string() +
                   "\nkey enter\nwait 0.2\nclick \"file name\"\nkey ctrl+a\ntype none.svg\nkey enter\nwait 0.1\nexpect "
                   "label \"File fault\"\n"
                   "click vase.svg\nwait 0.1\n"
                   "places\nclick \"by Name\"\nwait 0.1\nclick filter\ntype bowl\nwait 0.2\nplaces\nclick "
                   "bowl-two.svg\nwait 0.2\nexpect label Preview\nclick Open\nwait 0.1\nexpect label Width\n",
               "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(fs::exists(path("drafts") + "/one.tuft"));
    const std::size_t second = ran.out.find(" bowl-one.svg", ran.out.find(" bowl-one.svg") + 1);
    ASSERT_NE(second, std::string::npos);
    auto first = places(ran.out.substr(0, second - 40)),
         filtered = places(ran.out.substr(ran.out.rfind('\n', second) + 1));
    EXPECT_TRUE(first.contains("vase.svg"));
    EXPECT_FALSE(first.contains("File fault")) << "another file is chosen";
    EXPECT_FALSE(filtered.contains("vase.svg"));
    EXPECT_LT(first["bowl-one.svg"].second, first["bowl-two.svg"].second);
    EXPECT_GT(filtered["bowl-one.svg"].second, filtered["bowl-two.svg"].second) << "sorted the other way round";
}

// A lease (fcntl) makes who opens the file wait, as a disk does that is gone: up to 45 s, or until it is given back.
TEST_F(Panels, QuittingDoesNotWaitForAPreviewThatADiskNeverGives) {
    std::ofstream(path("slow.svg")) << "<svg viewBox='0 0 9 9'><path d='M1 1 l7 7' stroke='black'/></svg>";
    const auto before = signal(SIGIO, SIG_IGN);  // by which the system informs the holder of it
    const int file = ::open(path("slow.svg").c_str(), O_RDWR);
    ASSERT_GE(file, 0);
    if (::fcntl(file, F_SETLEASE, F_WRLCK) != 0) {
        ::close(file);
        signal(SIGIO, before);
        GTEST_SKIP() << "no leases on this file system";
    }
    const Ran ran = studio(kBowl + "set tool writing\nwait 0.1\nclick \"Writing or drawing...\"\nwait 0.2\nclick " +
                           "\"file name\"\nkey ctrl+a\ntype " + folder_.string() +
                           "\nkey enter\nwait 0.2\nclick slow.svg\nwait 0.3\nexpect label Preview\n");
    EXPECT_EQ(::fcntl(file, F_GETLEASE), F_RDLCK) << "the preview has asked for the file";
    // Would wait still: the lease is neither given back nor has its time run out.
    EXPECT_EQ(::open(path("slow.svg").c_str(), O_RDONLY | O_NONBLOCK), -1);
    EXPECT_EQ(errno, EWOULDBLOCK);
    ::fcntl(file, F_SETLEASE, F_UNLCK);
    ::close(file);
    signal(SIGIO, before);
    EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(Panels, TheLanguageIsChangedInTheMenuBarAndAMissingFontIsNamedWithItsPackage) {
    const bool with_fonts = fs::exists("/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc") ||
                            fs::exists("/usr/share/fonts/truetype/wqy/wqy-microhei.ttc");
    fs::create_directories(path("fonts"));
    setenv("TUFT_FONTS", path("fonts").c_str(), 1);
    const Ran none = studio(
        "wait 0.2\nclick \"Language button\"\nwait 0.3\nexpect message fonts-noto-cjk\nexpect label \"Language "
        "button\"\n");
    unsetenv("TUFT_FONTS");
    EXPECT_EQ(none.status, 0) << none.err;
    if (!with_fonts) GTEST_SKIP() << "no Chinese font is installed";
    fs::remove_all(path("state"));
    const Ran ran = studio("wait 0.2\nclick \"Language button\"\nwait 0.3\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(read(path("state") + "/tuft/settings").find("language chinese"), std::string::npos);
}

// What the studio names is stored in one language, so that a project reads the same in both.
TEST_F(Panels, NamesGivenInTheChineseWindowAreStoredAsInTheEnglishOne) {
    const Ran ran =
        studio(kBowl + "set language chinese\n" + kTwoStrokes +
                   "click \"Add a layer\"\nwait-ready\nwait 0.1\nclick \"layer Layer 2\"\nwait 0.1\n"
                   "click Duplicate\nwait-ready\nexpect label \"layer Layer 2 copy\"\n"
                   "key f2\nwait 0.2\nkey enter\nwait-ready\nexpect label \"layer Layer 2 copy\"\n"
                   "click \"fold Snapshots\"\nwait 0.1\nclick \"Take a snapshot\"\nwait-ready\n"
                   "click \"snapshot Snapshot 1\"\nwait 0.1\nclick \"Snapshot name\"\nkey enter\n"
                   "wait-ready\nexpect label \"snapshot Snapshot 1\"\n"
                   "click \"fold Snapshots\"\nwait 0.1\nclick \"stroke 1\"\nhold ctrl\nclick \"stroke "
                   "2\"\nhold none\nwait 0.1\nright-click \"stroke 1\"\nwait 0.1\nclick \"Make a group\"\n"
                   "wait-ready\nwait 0.1\nexpect label \"group Group\"\nset tool mask\nwait 0.1\nclick Lasso\n"
                   "stroke 45%,45% 55%,45% 55%,55% 45%,55%\nwait-ready\nexpect label \"mask Mask 1\"\n"
                   "save work.tuft\nwait-ready\n",
               "--headless --size 1280x1200");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json project = tuft("inspect '" + path("work.tuft") + "' --json");
    ASSERT_EQ(project["layers"].size(), 3u);
    EXPECT_EQ(project["layers"][1]["name"], "Layer 2");
    EXPECT_EQ(project["layers"][2]["name"], "Layer 2 copy");
}

// Two sheets, one over the other: hidden, locked, isolated, made of glass, undone; all of it stays in the project.
TEST_F(Panels, PartsAreHiddenLockedAndMadeOfGlass) {
    std::ofstream(path("m.obj")) << "o body\nv -30 -30 0\nv 30 -30 0\nv 30 30 0\nv -30 30 0\nf 1 2 3 4\n"
                                    "o pane\nv -30 -30 4\nv 30 -30 4\nv 30 30 4\nv -30 30 4\nf 5 6 7 8\n";
    const auto worked = [&](const std::string& language, const std::string& first) {
        return "open " + path("m.obj") + "\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\n" +
               "set language " + language + "\nwait 0.2\n" + first +
               "click \"show part pane\"\nwait-ready\nwait 0.1\nstroke 46%,50% 50%,52% 54%,50%\nwait-ready\n"
               "click \"lock part body\"\nwait-ready\nwait 0.1\nclick \"part pane\"\nwait 0.1\n"
               "click \"Part made of\"\nwait 0.2\nclick \"glass\"\nwait-ready\nwait 0.1\n"
               "click \"Isolate\"\nwait-ready\nwait 0.1\nclick \"Show all\"\nwait-ready\nsave " +
               path(language + ".tuft") + "\nwait-ready\n";
    };
    // The section stays open.
    const Ran ran = studio(worked("english", "click \"fold Parts\"\nwait 0.2\n") + worked("chinese", ""),
                           "--headless --size 1280x900");
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const char* language : {"english", "chinese"}) {
        const std::string project = path(std::string(language) + ".tuft");
        const nlohmann::json parts = tuft("part '" + project + "' list --json")["parts"];
        ASSERT_EQ(parts.size(), 2u);
        EXPECT_EQ(parts[0]["locked"], true);
        EXPECT_EQ(parts[0]["visible"], true);
        EXPECT_EQ(parts[1]["visible"], true);
        EXPECT_EQ(parts[1]["substrate"], "glass");
        const nlohmann::json entries = tuft("inspect '" + project + "' --json")["strokes"];
        EXPECT_EQ(entries.size(), 6u) << "hide, stroke, lock, glass, isolate, show all";
    }
}

// A CAD file states its unit. Another one may be said, and stays said where the file is read anew by another chord; one
// that agrees with the file is none.
TEST_F(Panels, ACadFileIsOpenedByItsChordAndInAUnitThatIsSaid) {
    const auto opened = [&](const std::string& unit) {
        const Ran ran =
            studio("open " + source_folder() +
                       "/tests/fuzz/corpus/stp/box.stp\nwait-ready\nexpect label \"CAD groups\"\nnames\n"
                       "click \"Unit\"\nwait 0.2\nclick \"" +
                       unit + "\"\nwait 0.2\nclick \"Chord tolerance\"\nwait 0.2\nclick \"0.5 mm\"\nwait-ready\n" +
                       "set texels 256\nclick \"Unwrap and paint\"\nwait-ready\nexpect model\nsave " +
                       path(unit + ".tuft") + "\nwait-ready\n",
                   "--headless --size 1280x720");
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(ran.out.find("\nUp\n"), std::string::npos) << "its axes are those of the model: " << ran.out;
        return io::Project::open(path(unit + ".tuft")).model();
    };
    const io::ProjectModel inches = opened("in"), millimetres = opened("mm");
    EXPECT_TRUE(inches.frame.unit_overrides);
    EXPECT_EQ(inches.frame.unit, "in");
    EXPECT_NEAR(inches.mesh.bounds.size().x, 30 * 0.0254, 1e-6);
    EXPECT_FALSE(millimetres.frame.unit_overrides);
    EXPECT_NEAR(millimetres.mesh.bounds.size().x, 0.03, 1e-8);
}

}  // namespace
}  // namespace tuft::app
