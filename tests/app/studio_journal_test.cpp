#include <gtest/gtest.h>

#include "io/image/image.h"
#include "io/project/project.h"
#include "studio_program.h"

/// The journal's list: groups, choosing, its menu, and how what is chosen is shown.
namespace tuft::app {
namespace {

const char* const kLarge = "--headless --size 1280x720";  // rows have room for their buttons

// Ten strokes of a drawing in two rows, one of them dipped into another ink.
std::string drawing() {
    std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 30 12' width='30mm'>";
    for (int i = 0; i < 5; ++i)
        svg += "<path fill='none' stroke='black' stroke-width='1' d='M" + std::to_string(2 + 6 * i) +
               " 2 l3 1'/><path fill='none' stroke='black' stroke-width='1' d='M" + std::to_string(2 + 6 * i) +
               " 9 l3 -1'/>";
    return svg + "</svg>";
}

class Journal : public StudioProgram {
  protected:
    void SetUp() override {
        StudioProgram::SetUp();
        std::ofstream(path("leaves.svg")) << drawing();
    }
    std::string placed() const {
        return kBowl + "open " + path("leaves.svg") +
               "\nmove 50%,59%\npress\nrelease\nwait-ready\nwait 0.1\nexpect strokes 10\n";
    }
    static int highlighted(const std::string& file) {
        const io::Image8 image = io::read_image8(file, std::size_t{1} << 24);
        int n = 0;
        for (std::size_t i = 0; i + 2 < image.pixels.size(); i += static_cast<std::size_t>(image.channels)) {
            // Only the model's view: between the panels.
            const auto x = static_cast<int>(i / static_cast<std::size_t>(image.channels)) % image.width;
            n += x > 300 && x < 560 && image.pixels[i + 2] > image.pixels[i] + 60;
        }
        return n;
    }
};

TEST_F(Journal, APlacedDrawingIsOneGroupThatIsHiddenMovedInkedAndDeletedAsOne) {
    const auto keep = [](const std::string& name) {
        return "wait-ready\nsave " + name + ".tuft\nwait-ready\nsave work.tuft\nwait-ready\n";
    };
    const Ran ran =
        studio(placed() + "set tool brush\nstroke 46%,62% 50%,63%\nwait-ready\n" + keep("placed") +
                   "click \"group leaves.svg\"\nclick Hide\n" + keep("hidden") + "click Show\nwait-ready\n" +
                   "right-click \"group leaves.svg\"\nwait 0.1\nclick Ink\nwait 0.1\nclick indigo\n" + keep("inked") +
                   "click Move\nmove 50%,59%\npress\nmove 53%,58%\nrelease\n" + keep("moved") + "undo\n" +
                   keep("back") + "key delete\nwait-ready\nexpect strokes 1\n" + keep("deleted") +
                   "undo\nundo\nundo\nundo\nwait-ready\nexpect strokes 11\n" + keep("undone"),
               kLarge);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto project = [this](const std::string& name) { return io::Project::open(path(name + ".tuft")).strokes(); };
    const auto placed_strokes = project("placed"), hidden = project("hidden"), inked = project("inked"),
               moved = project("moved"), undone = project("undone");
    ASSERT_EQ(placed_strokes.size(), 11u);
    const std::uint64_t group = placed_strokes[0].group.id;
    EXPECT_NE(group, 0u);
    for (std::size_t i = 0; i < 11; ++i) {
        const bool in = i < 10;
        EXPECT_EQ(placed_strokes[i].group, in ? (stroke::EntryGroup{group, "leaves.svg"}) : stroke::EntryGroup{}) << i;
        EXPECT_EQ(hidden[i].hidden, in) << i;
        EXPECT_EQ(stroke::ink_of(inked[i]), in ? "indigo" : "carbon") << i;
        EXPECT_EQ(stroke::brush_of(inked[i]), stroke::brush_of(placed_strokes[i])) << i;
        if (in) {
            EXPECT_GT(glm::distance(stroke::samples_of(moved[i]).placement.origin,
                                    stroke::samples_of(placed_strokes[i]).placement.origin),
                      1e-3)
                << i;
        }
        EXPECT_EQ(stroke::ink_of(undone[i]), "carbon") << i;
        EXPECT_EQ(stroke::samples_of(undone[i]).placement.origin,
                  stroke::samples_of(placed_strokes[i]).placement.origin)
            << i;
    }
    EXPECT_EQ(project("deleted").size(), 1u);
    EXPECT_EQ(test::stored_hash(path("undone.tuft")), test::stored_hash(path("placed.tuft")));
    EXPECT_EQ(test::stored_hash(path("back.tuft")), test::stored_hash(path("inked.tuft")));
    for (const char* name : {"placed", "hidden", "inked", "moved", "deleted"})
        EXPECT_EQ(tuft("replay '" + path(name) + ".tuft'")["canvas_hash"],
                  test::stored_hash(path(std::string(name) + ".tuft")))
            << name;
    const nlohmann::json reported = tuft("inspect '" + path("placed.tuft") + "'");
    ASSERT_EQ(reported["groups"].size(), 1u);
    EXPECT_EQ(reported["groups"][0]["name"], "leaves.svg");
    EXPECT_EQ(reported["groups"][0]["strokes"], 10);
}

TEST_F(Journal, AGroupOpensAndIsTakenApartAndEachSymmetricCopyIsOneOfItsOwn) {
    const Ran ran = studio(
        placed() +
            "expect label \"group leaves.svg\"\nclick \"open leaves.svg\"\nwait 0.1\nexpect label \"stroke "
            "10\"\nright-click \"stroke 10\"\nwait 0.1\nclick Delete\nwait-ready\n"
            "expect strokes 9\nright-click \"group leaves.svg\"\nwait 0.1\nclick Ungroup\nwait-ready\nwait 0.1\nexpect "
            "label \"stroke 9\"\nsave apart.tuft\nwait-ready\nsave work.tuft\nwait-ready\n"
            "set radial 3\nset tool writing\nmove 50%,63%\npress\nrelease\nwait-ready\nsave copies.tuft\nwait-ready\n",
        kLarge);
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const auto& s : io::Project::open(path("apart.tuft")).strokes()) EXPECT_EQ(s.group.id, 0u);
    std::map<std::uint64_t, int> sizes;
    for (const auto& s : io::Project::open(path("copies.tuft")).strokes()) ++sizes[s.group.id];
    ASSERT_EQ(sizes.size(), 4u) << "one of each copy, and the strokes that were taken apart";
    for (const auto& [id, n] : sizes) EXPECT_EQ(n, id == 0 ? 9 : 10) << id;
}

TEST_F(Journal, SeveralStrokesAreChosenAndChangedAtOnce) {
    const Ran ran =
        studio(kBowl + kTwoStrokes +
                   "stroke 50%,59% 53%,57%\nwait-ready\nclick \"stroke 3\"\nhold ctrl\nclick \"stroke 1\"\nhold "
                   "none\nwait 0.1\nclick \"Change ink\"\nwait 0.2\nclick indigo\nwait-ready\n"
                   "save some.tuft\nwait-ready\nsave work.tuft\nwait-ready\nundo\nwait-ready\nclick \"stroke 1\"\nwait "
                   "0.1\nhold shift\nclick \"stroke 3\"\nhold none\nkey delete\nwait-ready\nexpect strokes 0\n"
                   "undo\nwait-ready\nexpect strokes 3\nsave back.tuft\nwait-ready\n",
               kLarge);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto some = io::Project::open(path("some.tuft")).strokes(),
               back = io::Project::open(path("back.tuft")).strokes();
    const char* inks[] = {"indigo", "cinnabar", "indigo"};
    ASSERT_EQ(some.size(), 3u);
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(stroke::ink_of(some[i]), inks[i]) << i;
    EXPECT_EQ(stroke::ink_of(back[0]), "carbon");
}

// Black ink on white glaze: what is blue in the view is the highlight.
TEST_F(Journal, AChosenStrokeShowsItsInkUntilOnePaints) {
    const std::string look = "move 5%,5%\nwait 0.2\nscreenshot ";
    const Ran ran = studio(
        kBowl + "stroke 46%,58% 50%,61% 54%,58%\nwait-ready\n" + look + "before.png\nclick \"stroke 1\"\nwait-ready\n" +
        look + "chosen.png\nstroke 46%,66% 47%,66%\nwait-ready\n" + look +
        "painted.png\nclick \"stroke 1\"\nwait-ready\nclick \"stroke 1\"\nwait-ready\n" + look +
        "left.png\nclick \"stroke 1\"\nwait-ready\nkey escape\nwait-ready\n" + look + "escaped.png\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const int before = highlighted(path("before.png"));
    EXPECT_GT(highlighted(path("chosen.png")), before + 30);  // the stroke is 28 pixels long
    for (const char* file : {"painted.png", "left.png", "escaped.png"})
        EXPECT_LT(highlighted(path(file)), before + 10) << file;
}

// Old files say nothing of groups.
TEST_F(Journal, TheCommandLineMakesAGroupOfEachStrokeFile) {
    std::ofstream(path("a.svg")) << drawing();
    tuft("paint '" + source_folder() + "/models/bowl.ply' --atlas-size 256 --strokes '" + path("leaves.svg") + "' '" +
         path("a.svg") + "' --project '" + path("two.tuft") + "'");
    tuft("paint '" + path("two.tuft") + "' --strokes '" + path("a.svg") + "'");
    const nlohmann::json reported = tuft("inspect '" + path("two.tuft") + "'");
    ASSERT_EQ(reported["groups"].size(), 3u);
    std::set<std::uint64_t> ids;
    for (const auto& group : reported["groups"]) {
        ids.insert(group["id"].get<std::uint64_t>());
        EXPECT_EQ(group["strokes"], 10);
    }
    EXPECT_EQ(ids.size(), 3u);
    EXPECT_EQ(reported["groups"][0]["name"], "leaves.svg");
}

}  // namespace
}  // namespace tuft::app
