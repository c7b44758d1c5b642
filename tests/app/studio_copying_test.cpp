#include <gmock/gmock.h>

#include "copied_picture.h"
#include "stroke/journal/journal.h"
#include "studio_program.h"

/// A character copied from a picture and corrected by hand, in the real program.
namespace tuft::app {
namespace {

class StudioCopying : public StudioProgram {
  protected:
    void SetUp() override {
        StudioProgram::SetUp();
        write_cross(path("cross.png"));
    }
    static constexpr const char* kWindow = "--headless --size 1280x720";
    /// The picture in the tool that writes, its strokes shown.
    std::string copied() const {
        return kBowl + "set tool text\nset text-like " + path("cross.png") +
               "\nset text \xe5\x8d\x81\nset text-size 20\nwait-ready\nwait 0.2\nexpect label \"Stroke 2\"\n";
    }
    /// Between the panels.
    static std::string write_for(int n) { return click_for(n, "45%,62%"); }
    /// Whether a stroke runs to the right.
    static bool goes_right(const stroke::JournalEntry& entry) {
        const auto& samples = std::get<stroke::PaintStroke>(entry.content).trace.samples;
        return samples.back().position.x > samples.front().position.x;
    }
};

TEST_F(StudioCopying, ACorrectedOrderIsPaintedInOneGroupAndKeptWithTheProject) {
    const Ran first = studio(copied() + write_for(2) + "click \"Stroke 1\"\nwait 0.2\n" + write_for(4) +
                                 "expect message --order\nsave work.tuft\nwait-ready\n",
                             kWindow);
    ASSERT_EQ(first.status, 0) << first.err;
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 4u);
    EXPECT_TRUE(goes_right(strokes[0]));
    EXPECT_FALSE(goes_right(strokes[2])) << "the horizontal stroke was reversed";
    EXPECT_EQ(strokes[2].group, strokes[3].group);
    EXPECT_NE(strokes[0].group.id, strokes[2].group.id);
    EXPECT_EQ(tuft("replay '" + path("work.tuft") + "'")["canvas_hash"], test::stored_hash(path("work.tuft")));
    fs::remove(path("cross.png"));  // the project has it
    const Ran second =
        studio("open " + path("work.tuft") + "\nwait-ready\nset tool text\nclick \"\xe2\x96\xbe##kept\"\n" +
                   "click \"kept \xe5\x8d\x81  cross.png\"\nwait-ready\nset text-size 20\n" +
                   "expect label \"Stroke 2\"\n" + write_for(6) + "save work.tuft\nwait-ready\n",
               kWindow);
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_FALSE(goes_right(io::Project::open(path("work.tuft")).strokes()[4]));
}

TEST_F(StudioCopying, StrokesAreDraggedSplitRemovedJoinedAndTakenBackAndThePictureChosenAnewIsWhole) {
    const std::string told = "wait-ready\nwait 0.2\nplaces\nreport\n", back = "click \"Step back\"\n" + told;
    const Ran ran = studio(copied() + "move \"Order 1\"\npress\nwait 0.1\nmove \"Order 2\"\nwait 0.1\nrelease\n" +
                               "wait-ready\nwait 0.2\n" + write_for(2) + "save work.tuft\nwait-ready\n" + back +
                               "click Split\nmove \"Copied picture\"\nwait 0.1\nclick \"Stroke 1\"\n" + told + back +
                               "click Remove\nclick \"Stroke 1\"\n" + told + back +
                               "click Join\nclick \"Stroke 1\"\nclick \"Stroke 2\"\n" + told + "set text-like " +
                               path("cross.png") + "\n" + told,
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    // 十: the middles of its strokes differ little, so where the first one is tells the order by what is painted.
    const auto strokes = io::Project::open(path("work.tuft")).strokes();
    ASSERT_EQ(strokes.size(), 2u);
    EXPECT_TRUE(goes_right(strokes[1])) << "the horizontal stroke comes last";

    const auto turns = places_in_turn(ran.out);
    std::vector<int> shown;
    for (const auto& labels : turns)
        shown.push_back(labels.contains("Stroke 3") ? 3 : labels.contains("Stroke 2") ? 2 : 1);
    // Dragged and back, split and back, removed and back, joined, and the picture chosen anew.
    EXPECT_THAT(shown, testing::ElementsAre(2, 3, 2, 1, 2, 1, 2));
}

// What is saved is a source of characters.
TEST_F(StudioCopying, IsSavedAsAFileThatTheToolAndTheCommandRead) {
    fs::create_directories(path("glyphs"));
    const std::string file = path("glyphs/\xe5\x8d\x81.json");
    const Ran ran = studio(copied() + "click Save...\nwait 0.3\nkey ctrl+a\ntype \"" + file +
                               "\"\nkey enter\nwait 0.3\nexpect message Saved\n",
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    ASSERT_TRUE(fs::exists(file));
    const nlohmann::json written = tuft("write '" + source_folder() +
                                        "/models/sheet.ply' --place 0,0,0 --atlas-size 256 --text "
                                        "\xe5\x8d\x81 --fit --size 30 --glyphs '" +
                                        path("glyphs") + "' --project '" + path("a.tuft") + "'");
    EXPECT_EQ(written.at("strokes").size(), 2u);
}

// The number in the hand is of strokes that are not there any more.
TEST_F(StudioCopying, StrokesReadAnewUnderADragOfTheirNumbersAreNotMoved) {
    const std::string one_stroke = "set copy-order 2+3\nwait-ready\nwait 0.2\n";
    const Ran ran = studio(copied() + "move \"Order 2\"\npress\nwait 0.1\n" + one_stroke +
                               "move \"Order 1\"\nwait 0.2\nrelease\nwait 0.2\nplaces\nclick \"Step back\"\n" +
                               "wait-ready\nexpect label \"Stroke 2\"\n",
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_FALSE(places(ran.out).contains("Stroke 2"));
}

// What follows the end of a PNG is no part of the picture.
TEST_F(StudioCopying, APictureTooLargeForTheProjectIsWrittenAndItIsSaidThatItIsNotKept) {
    fs::resize_file(path("cross.png"), (24u << 20) + 1);
    const Ran ran = studio(copied() + write_for(2) + "wait-ready\nexpect message \"not kept\"\nsave work.tuft\n" +
                               "wait-ready\nexpect strokes 2\n",
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(io::Project::open(path("work.tuft")).attachments(io::kCopies).empty());
}

TEST_F(StudioCopying, APictureWithoutInkIsAFaultAndATextCanBeWrittenAgain) {
    std::vector<std::uint8_t> white(64 * 64, 255);
    io::write_image(path("white.png"), io::view_of(64, 64, 1, white.data()));
    const Ran ran = studio(kBowl + "set tool text\nset text-like " + path("white.png") +
                               "\nwait-ready\nexpect label \"Text fault\"\nclick \"\xc3\x97##like\"\nset text "
                               "\xe6\xb0\xb8\nset text-size 20\n" +
                               write_for(5),
                           kWindow);
    EXPECT_EQ(ran.status, 0) << ran.err;
}

}  // namespace
}  // namespace tuft::app
