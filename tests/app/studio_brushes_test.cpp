#include "brush/preset/preset.h"
#include "core/files/files.h"
#include "stroke/journal/journal.h"
#include "studio_program.h"

/// The rack of brushes and the window with all of them, as a person finds them.
namespace tuft::app {
namespace {

class StudioBrushes : public StudioProgram {
  protected:
    static constexpr const char* kWindow = "--headless --size 1280x720";
    static bool shows(const std::string& out, const std::string& label) { return places(out).contains(label); }
};

TEST_F(StudioBrushes, EachShippedOneHangsInTheRack) {
    const Ran ran = studio(kBowl + "wait 0.2\nplaces\n", kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const std::string& name : brush::list_presets()) EXPECT_TRUE(shows(ran.out, name)) << name;
}

// Letters of the name in the language of the interface, or of the name in files.
TEST_F(StudioBrushes, AreFoundByNameInBothLanguages) {
    for (const std::string& typed : {std::string("sponge"), std::string("set language chinese"), std::string("spo")}) {
        const bool chinese = typed.starts_with("set");
        const Ran ran = studio(kBowl + (chinese ? "set language chinese\nwait 0.3\n" : "") +
                                   "click \"All brushes\"\nexpect label \"card goat-small\"\nclick \"Brush "
                                   "filter\"\ntype " +
                                   (chinese ? "\xe6\xb5\xb7\xe7\xbb\xb5" : typed) +
                                   "\nwait 0.3\nplaces\nclick \"card sponge-30\"\n" +
                                   "wait 0.2\nstroke 46%,58% 50%,61%\nwait-ready\nsave work.tuft\nwait-ready\n",
                               kWindow);
        ASSERT_EQ(ran.status, 0) << typed << ": " << ran.err;
        EXPECT_TRUE(shows(ran.out, "card sponge-30")) << typed;
        EXPECT_FALSE(shows(ran.out, "card goat-small")) << typed;
    }
}

// The window lies over the view, and is put away by the button that opened it.
TEST_F(StudioBrushes, ACardTakesTheBrushThatPaintsNext) {
    const Ran ran = studio(kBowl +
                               "click \"All brushes\"\nclick \"card goat-large\"\nclick \"All brushes\"\nwait "
                               "0.2\nplaces\n" +
                               kTwoStrokes.substr(0, kTwoStrokes.find("set brush")) +
                               "wait-ready\nexpect strokes 1\nsave work.tuft\nwait-ready\n",
                           kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_FALSE(shows(ran.out, "card goat-large"));
    EXPECT_EQ(stroke::brush_of(io::Project::open(path("work.tuft")).strokes().front()), "goat-large");
}

TEST_F(StudioBrushes, AFileOfOnesOwnIsOneOfThemAndIsThereAtTheNextStart) {
    const std::vector<char> toml = read_file(source_folder() + "/models/brushes/wolf-small.toml");
    write_file(path("house-painter.toml"), toml.data(), toml.size());
    const std::string file = path("house-painter.toml");
    const Ran first = studio(kBowl + "open " + file + "\nwait 0.3\nexpect label " + file +
                                 "\nstroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 1\nsave work.tuft\nwait-ready\n",
                             kWindow);
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(stroke::brush_of(io::Project::open(path("work.tuft")).strokes().front()), file);
    const Ran second = studio("open " + path("work.tuft") + "\nwait-ready\nexpect strokes 1\nexpect label " + file +
                                  "\nclick \"All brushes\"\nclick \"Brush filter\"\ntype painter\nwait 0.3\nexpect "
                                  "label \"card " +
                                  file + "\"\n",
                              kWindow);
    EXPECT_EQ(second.status, 0) << second.err;
}

// A disk that is not plugged in.
TEST_F(StudioBrushes, AFileThatIsAwayKeepsItsPlaceSaysSoAndWorksAgainWhenItIsBack) {
    const std::vector<char> toml = read_file(source_folder() + "/models/brushes/wolf-small.toml");
    const std::string file = path("house-painter.toml");
    write_file(file, toml.data(), toml.size());
    // The brush in the hand when the model is left is the one that it is opened with.
    const Ran first = studio(kBowl + "open " + file + "\nwait 0.3\nsave work.tuft\nwait-ready\n", kWindow);
    ASSERT_EQ(first.status, 0) << first.err;
    const std::string again = "open " + path("work.tuft") + "\nwait-ready\n",
                      browse = "click \"All brushes\"\nclick \"Brush filter\"\ntype painter\nwait 0.3\n",
                      painted = "stroke 46%,58% 50%,61%\nwait-ready\n";
    fs::rename(file, file + ".away");
    const Ran away =
        studio(again + "expect label " + file + "\nexpect message away\n" + painted + browse + "expect label \"away " +
                   file + "\"\nclick \"card " + file + "\"\nexpect message away\nclick \"All brushes\"\nwait 0.2\n" +
                   painted + "expect strokes 2\nsave work.tuft\nwait-ready\n",
               kWindow);
    ASSERT_EQ(away.status, 0) << away.err;
    for (const stroke::JournalEntry& entry : io::Project::open(path("work.tuft")).strokes())
        EXPECT_NE(stroke::brush_of(entry), file) << "another one is in the hand";
    fs::rename(file + ".away", file);
    const Ran back = studio(again + painted + browse + "places\nsave work.tuft\nwait-ready\n", kWindow);
    ASSERT_EQ(back.status, 0) << back.err;
    EXPECT_TRUE(shows(back.out, "card " + file));
    EXPECT_FALSE(shows(back.out, "away " + file));
    EXPECT_EQ(stroke::brush_of(io::Project::open(path("work.tuft")).strokes().back()), file) << "in the hand again";
}

TEST_F(StudioBrushes, AFileOfOnesOwnIsTakenOffTheList) {
    const std::string file = path("house-painter.toml");
    const std::vector<char> toml = read_file(source_folder() + "/models/brushes/wolf-small.toml");
    write_file(file, toml.data(), toml.size());
    const Ran first = studio(kBowl + "open " + file + "\nwait 0.3\nclick goat-small\nclick \"All brushes\"\n" +
                                 "click \"Brush filter\"\ntype painter\nwait 0.3\nclick \"forget " + file +
                                 "\"\nwait 0.2\nplaces\n" + "wait 0.1\n",
                             kWindow);
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_FALSE(shows(first.out, file));
    EXPECT_TRUE(fs::exists(file));
    const Ran second = studio(kBowl + "wait 0.2\nplaces\n", kWindow);
    EXPECT_FALSE(shows(second.out, file));
}

// A fault is told of what the file is.
TEST_F(StudioBrushes, ADamagedBrushIsNoBadInkNorADamagedInkABadBrush) {
    const auto damaged = [&](const std::string& name, const std::string& shipped, const std::string& line,
                             const std::string& by) {
        std::string text = read(source_folder() + "/models/" + shipped);
        text.replace(text.find(line), line.size(), by);
        write_file(path(name), text.data(), text.size());
        return path(name);
    };
    const std::string brush = damaged("brush.toml", "brushes/wolf-small.toml", "length_mm = 20", "length_mm = -1"),
                      ink = damaged("ink.toml", "inks/carbon.toml", "fraction = 1.0", "fraction = 3.0");
    const Ran ran = studio(kBowl + "open " + brush + "\nwait 0.2\nexpect message length_mm\nopen " + ink +
                               "\nwait 0.2\nexpect message fraction\n",
                           kWindow);
    EXPECT_EQ(ran.status, 0) << ran.err;
}

}  // namespace
}  // namespace tuft::app
