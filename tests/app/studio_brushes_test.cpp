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

// Letters of the name in the language of the interface, or of the name in files.
TEST_F(StudioBrushes, EachShippedOneHangsInTheRackAndIsFoundByNameInBothLanguages) {
    struct Search {
        const char *language, *typed;
    };
    const std::vector<Search> searches{
        {"english", "sponge"}, {"chinese", "\xe6\xb5\xb7\xe7\xbb\xb5"}, {"chinese", "spo"}};
    std::string script = kBowl + "wait 0.2\nplaces\nreport\n";
    for (const Search& s : searches)
        script += "set language " + std::string(s.language) +
                  "\nwait 0.3\nclick \"All brushes\"\nexpect label \"card goat-small\"\nclick \"Brush filter\"\ntype " +
                  s.typed + "\nwait 0.3\nplaces\nreport\nclick \"card sponge-30\"\nclick \"Brush filter\"\nkey " +
                  "ctrl+a\nkey delete\nclick \"All brushes\"\nwait 0.2\n";
    const Ran ran = studio(script, kWindow);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto turns = places_in_turn(ran.out);
    ASSERT_EQ(turns.size(), 1 + searches.size());
    for (const std::string& name : brush::list_presets()) EXPECT_TRUE(turns[0].contains(name)) << name;
    for (std::size_t i = 0; i < searches.size(); ++i) {
        EXPECT_TRUE(turns[i + 1].contains("card sponge-30")) << searches[i].typed;
        EXPECT_FALSE(turns[i + 1].contains("card goat-small")) << searches[i].typed;
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

// A disk that is not plugged in, and is again. A damaged file's error names its kind: brush or ink.
TEST_F(StudioBrushes, AFileOfOnesOwnIsThereAtEachStartAlsoWhileItIsMissingUntilItIsTakenOffTheList) {
    const auto copied = [&](const std::string& name, const std::string& shipped, const std::string& line,
                            const std::string& by) {
        std::string text = read(source_folder() + "/models/" + shipped);
        text.replace(text.find(line), line.size(), by);
        write_file(path(name), text.data(), text.size());
        return path(name);
    };
    const std::string file = copied("house-painter.toml", "brushes/wolf-small.toml", "", ""),
                      brush = copied("brush.toml", "brushes/wolf-small.toml", "length_mm = 20", "length_mm = -1"),
                      ink = copied("ink.toml", "inks/carbon.toml", "fraction = 1.0", "fraction = 3.0");
    const std::string again = "open " + path("work.tuft") + "\nwait-ready\n",
                      browse = "click \"All brushes\"\nclick \"Brush filter\"\ntype painter\nwait 0.3\n",
                      painted = "stroke 46%,58% 50%,61%\nwait-ready\n", saved = "save work.tuft\nwait-ready\n";
    const auto brush_of = [&](std::size_t stroke) {
        return stroke::brush_of(io::Project::open(path("work.tuft")).strokes().at(stroke));
    };
    // The brush in the hand when the model is left is the one that it is opened with.
    const Ran first = studio(kBowl + "open " + file + "\nwait 0.3\nexpect label " + file + "\n" + painted + "open " +
                                 brush + "\nwait 0.2\nexpect message length_mm\nopen " + ink +
                                 "\nwait 0.2\nexpect message fraction\nexpect strokes 1\n" + saved,
                             kWindow);
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(brush_of(0), file);

    fs::rename(file, file + ".away");
    const Ran away = studio(again + "expect label " + file + "\nexpect message missing\n" + painted + browse +
                                "expect label \"missing " + file + "\"\nclick \"card " + file +
                                "\"\nexpect message missing\nclick \"All brushes\"\nwait 0.2\n" + painted +
                                "expect strokes 3\n" + saved,
                            kWindow);
    ASSERT_EQ(away.status, 0) << away.err;
    for (const std::size_t stroke : {1, 2}) EXPECT_NE(brush_of(stroke), file) << "another one is in the hand";

    fs::rename(file + ".away", file);
    const Ran back = studio(again + painted + browse + "places\nreport\n" + saved +
                                "click goat-small\nclick \"forget " + file + "\"\nwait 0.2\nplaces\nreport\n",
                            kWindow);
    ASSERT_EQ(back.status, 0) << back.err;
    EXPECT_EQ(brush_of(3), file) << "in the hand again";
    const auto turns = places_in_turn(back.out);
    ASSERT_EQ(turns.size(), 2u);
    EXPECT_TRUE(turns[0].contains("card " + file));
    EXPECT_FALSE(turns[0].contains("missing " + file));
    EXPECT_TRUE(turns[1].contains("goat-small"));
    EXPECT_FALSE(turns[1].contains(file));
    EXPECT_TRUE(fs::exists(file));

    const Ran last = studio(kBowl + "wait 0.2\nplaces\n", kWindow);
    ASSERT_EQ(last.status, 0) << last.err;
    EXPECT_TRUE(shows(last.out, "goat-small"));
    EXPECT_FALSE(shows(last.out, file));
}

}  // namespace
}  // namespace tuft::app
