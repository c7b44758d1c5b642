#include <map>

#include "stroke/journal/journal.h"
#include "studio_program.h"

namespace tuft::app {
namespace {

/// The tool that writes, in the real program.
class StudioLettering : public StudioProgram {
  protected:
    static constexpr const char* kWindow = "--headless --size 1280x720";
    static constexpr const char* kYong = "\xe6\xb0\xb8";  // 永, of five strokes

    std::string written(const std::string& text) const {
        return kBowl + "set tool text\nset text " + text + "\nset text-size 20\nwait-ready\nmove 52%,62%\nwait 0.1\n";
    }
    std::vector<stroke::JournalEntry> project(const std::string& name) const {
        return io::Project::open(path(name)).strokes();
    }
};

// The field has the keyboard when the tool is taken for the first time: one types, and clicks on the model.
TEST_F(StudioLettering, ATypedTextIsWrittenWhereOneClicksAndUndoneAsOne) {
    const Ran ran =
        studio(kBowl + "set tool text\nwait 0.3\ntype " + kYong + "\nwait-ready\nset text-size 20\n" + click_for(5) +
                   "expect message --direction\nsave work.tuft\nwait-ready\nundo\n"
                   "wait-ready\nexpect strokes 0\nredo\nwait-ready\nexpect strokes 5\n",
               kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = project("work.tuft");
    ASSERT_EQ(strokes.size(), 5u);
    for (const stroke::JournalEntry& entry : strokes) EXPECT_EQ(entry.group.name, kYong);
    EXPECT_NE(strokes.front().group.id, 0u);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
}

TEST_F(StudioLettering, WithoutATextOrWithAMissingCharacterAClickWritesNothing) {
    const std::string click = "press\nrelease\nwait-ready\nexpect strokes 0\n";
    const Ran ran = studio(kBowl + "set tool text\nwait-ready\nmove 52%,62%\nwait 0.1\nplaces\n" + click +
                               "set text \xe9\x91\xab\nwait-ready\nwait 0.1\nexpect label \"Text fault\"\n" + click +
                               "set text \" \"\nwait-ready\nwait 0.1\n" + click,
                           kWindow);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out.find("Text fault"), std::string::npos) << "an empty text is no fault";
}

TEST_F(StudioLettering, EachDirectionIsChosenInThePanelAndALineThatIsTooLongIsRefused) {
    const Ran ran = studio(
        written(kYong) + "click Down\n" + click_for(5) + "click Round\n" + click_for(10) +
            "click \"Curve##direction\"\nmove "
            "52%,62%\nwait 0.2\nexpect label \"Text fault\"\npress\nrelease\nwait-ready\nexpect strokes 10\n"
            // The curve of the tool Curve, before it is painted.
            "set tool curve\nwait 0.1\nmove 46%,62%\npress\nrelease\nmove 52%,64%\npress\nrelease\nmove "
            "58%,62%\npress\nrelease\nwait 0.1\nset tool text\nmove 52%,63%\nwait 0.1\npress\nrelease\nwait-ready\n"
            "expect strokes 15\nset text-size 500\nwait 0.1\npress\nrelease\nwait-ready\nexpect strokes 15\nexpect "
            "message \"mm long\"\nsave work.tuft\nwait-ready\n",
        kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::map<std::uint64_t, int> groups;
    for (const stroke::JournalEntry& entry : project("work.tuft")) ++groups[entry.group.id];
    EXPECT_EQ(groups.size(), 3u) << "each click is a group";
}

// Why a text cannot lie under the cursor is shown only while the cursor is on the model: the buttons stay where they
// are.
TEST_F(StudioLettering, TheFaultOfAPlaceMovesNoButtonAwayFromAClick) {
    const Ran ran = studio(written(kYong) +
                               "click \"Curve##direction\"\nmove 52%,62%\nwait 0.2\nexpect label \"Text fault\"\n"
                               "click Round\nmove 52%,62%\nwait 0.2\npress\nrelease\nwait-ready\nexpect strokes 5\n",
                           kWindow);
    EXPECT_EQ(ran.status, 0) << ran.err;
}

// A brush taken from the rack while the tool is active is the one that writes.
TEST_F(StudioLettering, TheStylesBrushIsUsedUntilAnotherOneIsTaken) {
    const Ran ran = studio(
        written(kYong) + click_for(5) + "click wolf-small\n" + click_for(10) + "save work.tuft\nwait-ready\n", kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = project("work.tuft");
    ASSERT_EQ(strokes.size(), 10u);
    EXPECT_EQ(stroke::brush_of(strokes[0]).rfind("goat-medium*", 0), 0u) << stroke::brush_of(strokes[0]);
    EXPECT_EQ(stroke::brush_of(strokes[5]).rfind("wolf-small", 0), 0u) << stroke::brush_of(strokes[5]);
}

// The brush that a project is opened with is the last one in its journal: not a choice of another brush than the
// style's, which is larger for larger characters.
TEST_F(StudioLettering, AProjectOpenedAgainKeepsTheStylesBrushAndItsGroup) {
    const Ran ran = studio(written(kYong) + click_for(5) + "save work.tuft\nwait-ready\nclose\nwait 0.2\nopen \"" +
                               path("work.tuft") + "\"\nwait-ready\nexpect strokes 5\nexpect label \"group " + kYong +
                               "\"\nset text-size 30\n" + click_for(10) + "wait 0.2\n",
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto strokes = project("work.tuft");
    ASSERT_EQ(strokes.size(), 10u);
    EXPECT_NE(stroke::brush_of(strokes[0]), stroke::brush_of(strokes[5]));
    EXPECT_EQ(stroke::brush_of(strokes[5]).rfind("goat-medium*", 0), 0u) << stroke::brush_of(strokes[5]);
}

// The window goes on while a long text is planned, and a stop leaves nothing of it.
TEST_F(StudioLettering, ALongTextIsPlannedBesideTheWindowAndCanBeStopped) {
    std::string text;
    for (int i = 0; i < 30; ++i) text += "\xe6\xb0\xb8\xe6\x98\xa5\xe9\xa2\xa8\xe5\xbf\x83";
    const Ran ran = studio(kBowl + "set tool text\nset text " + text +
                               "\nset text-size 3.7\nwait-ready\nmove 52%,62%\nwait 0.1\npress\nrelease\nawait label "
                               "Stop\nclick Stop\nwait-ready\nexpect strokes 0\n",
                           kWindow);
    EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(StudioLettering, ThePanelFitsTheSmallestWindowItIsMadeForInBothLanguages) {
    std::string script = written(kYong) + "set scale 1.5\nwait 0.3\nclick \"In mm\"\n";
    for (const char* language : {"english", "chinese"})
        script += "set language " + std::string(language) + "\nwait 0.3\nplaces\nreport\n";
    const Ran ran = studio(script, kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 2u);
    for (const auto& labels : turns) EXPECT_TRUE(labels.contains("Place it there"));
}

}  // namespace
}  // namespace tuft::app
