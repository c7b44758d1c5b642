#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/widgets/manual_text.h"
#include "io/image/image.h"
#include "io/project/project.h"
#include "studio_program.h"

/// Reference images, snapshots, the guide and the manual.
namespace tuft::app {
namespace {

class Views : public StudioProgram {
  protected:
    // A picture that is red all over.
    void write_red(const std::string& name, int width = 60, int height = 30) const {
        std::vector<std::uint8_t> rgb;
        for (int i = 0; i < width * height; ++i) rgb.insert(rgb.end(), {230, 20, 30});
        io::write_image(path(name), io::view_of(width, height, 3, rgb.data()));
    }
    // Red pixels of the picture between two columns; right of 960 is the cross of axes, whose x is red.
    static int red(const std::string& file, int from, int to) {
        const io::Image8 image = io::read_image8(file, std::size_t{1} << 24);
        int n = 0;
        for (int y = 60; y < image.height - 40; ++y)
            for (int x = from; x < to; ++x) {
                const std::uint8_t* p =
                    &image.pixels[static_cast<std::size_t>(image.channels) *
                                  (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x))];
                n += p[0] > p[1] + 60 && p[0] > p[2] + 60;
            }
        return n;
    }
    std::size_t strokes(const std::string& project) const { return io::Project::open(path(project)).strokes().size(); }
};

TEST_F(Views, AReferenceImageIsPinnedMovedFadedAndThereAgainWithItsProject) {
    write_red("leaf.png");
    const Ran ran =
        studio(kBowl + "open " + path("leaf.png") +
                   "\nwait 0.2\nexpect label \"reference leaf.png\"\nscreenshot pinned.png\nmove 45%,12%\nsave "
                   "a.tuft\nwait-ready\nsave work.tuft\nwait-ready\n"
                   // By its middle, to the right and down; then another one, which is no image.
                   "move 18%,14%\npress\nmove 30%,20%\nmove 48%,26%\nrelease\nwait-ready\nopen " +
                   path("script.txt") +
                   ".png\nwait 0.1\nexpect message script.txt.png\nsave b.tuft\nwait-ready\nexpect strokes 0\n",
               "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto about = [this](const std::string& project) {
        const auto images = io::Project::open(path(project)).attachments(io::kReferences);
        EXPECT_EQ(images.size(), 1u);
        return images.empty() ? nlohmann::json::object() : nlohmann::json::parse(images[0].about);
    };
    const nlohmann::json before = about("a.tuft"), after = about("b.tuft");
    EXPECT_EQ(before["name"], "leaf.png");
    EXPECT_GT(after["x"].get<double>(), before["x"].get<double>() + 0.2);
    EXPECT_GT(after["y"].get<double>(), before["y"].get<double>() + 0.05);
    EXPECT_GT(red(path("pinned.png"), 284, 960), 5000);
    const Ran again =
        studio("open " + path("b.tuft") +
                   "\nwait-ready\nexpect model\nwait 0.2\nexpect label \"reference leaf.png\"\nclick \"fold "
                   "References\"\nwait 0.1\nclick \"show leaf.png\"\nwait-ready\nwait 0.1\n"
                   "screenshot hidden.png\nclick \"remove leaf.png\"\nwait-ready\nsave c.tuft\nwait-ready\n",
               "--headless --size 1280x720");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_LT(red(path("hidden.png"), 284, 960), 50);
    EXPECT_TRUE(io::Project::open(path("c.tuft")).attachments(io::kReferences).empty());
    EXPECT_EQ(io::Project::open(path("b.tuft")).attachments(io::kReferences).size(), 0u)
        << "it was worked on until it had another name";
}

TEST_F(Views, ASnapshotIsRestoredAsOneStepAndNothingIsLostByIt) {
    const auto keep = [](const std::string& name) {
        return "wait-ready\nsave " + name + ".tuft\nwait-ready\nsave work.tuft\nwait-ready\n";
    };
    const Ran ran =
        studio(kBowl + kTwoStrokes + keep("two") +
                   "click \"fold Snapshots\"\nwait 0.1\nclick \"Take a snapshot\"\nwait-ready\nwait 0.1\nexpect label "
                   "\"snapshot Snapshot 1\"\n"
                   "click \"stroke 2\"\nwait-ready\nclick \"Change ink\"\nwait 0.2\nclick indigo\nwait-ready\nkey "
                   "escape\nstroke 50%,59% 53%,57%\nwait-ready\nexpect strokes 3\n" +
                   keep("three") + "click \"snapshot Snapshot 1\"\nwait 0.1\nclick Restore\n" + keep("restored") +
                   "expect strokes 2\nundo\n" + keep("undone") +
                   "expect strokes 3\nredo\nwait-ready\nexpect strokes 2\n"
                   "stroke 50%,59% 53%,57%\nwait-ready\nundo\nundo\nwait-ready\nexpect strokes 3\nexpect kept\n" +
                   keep("end"),
               "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto hash = [this](const std::string& project) { return test::stored_hash(path(project)); };
    EXPECT_EQ(hash("restored.tuft"), hash("two.tuft"));
    EXPECT_EQ(hash("undone.tuft"), hash("three.tuft"));
    EXPECT_EQ(hash("end.tuft"), hash("three.tuft"));
    EXPECT_NE(hash("three.tuft"), hash("two.tuft"));
    EXPECT_EQ(tuft("replay '" + path("restored.tuft") + "'")["canvas_hash"], hash("two.tuft"));
    const auto snapshots = io::Project::open(path("end.tuft")).attachments(io::kSnapshots);
    ASSERT_EQ(snapshots.size(), 1u);
    EXPECT_EQ(io::unpack_entries(snapshots[0].bytes, "it").size(), 2u);
    EXPECT_EQ(nlohmann::json::parse(snapshots[0].about)["name"], "Snapshot 1");
    // Opened again it can still be gone back to.
    const Ran again =
        studio("open " + path("end.tuft") +
                   "\nwait-ready\nexpect strokes 3\nwait 0.1\nclick \"snapshot Snapshot 1\"\nwait 0.1\nclick "
                   "\"Snapshot name\"\nkey ctrl+a\ntype Fired\nkey enter\nwait-ready\nwait 0.1\n"
                   "expect label \"snapshot Fired\"\nclick Restore\nwait-ready\nexpect strokes 2\nsave "
                   "later.tuft\nwait-ready\n",
               "--headless --size 1280x720");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(hash("later.tuft"), hash("two.tuft"));
}

// The snapshot has no ink yet, the work a red stroke.
TEST_F(Views, ASnapshotIsComparedSideBySideAndByASwipe) {
    const std::string look = "move 5%,5%\nwait 0.3\nwait-ready\nscreenshot ";
    const Ran ran = studio(
        kBowl +
            "click \"fold Snapshots\"\nwait 0.1\nclick \"Take a snapshot\"\nwait-ready\nset ink cinnabar\nset pressure "
            "0.9\nstroke 46%,58% 50%,62% 54%,58%\nwait-ready\nclick \"snapshot Snapshot 1\"\nwait 0.1\nclick Compare\n"
            "wait-ready\n" +
            look + "side.png\nclick Swipe\n" + "set swipe 0.9\n" + look + "old.png\nset swipe 0.1\n" + look +
            "new.png\n"
            // What is pressed on the snapshot paints nothing; on the work it does.
            "stroke 5%,58% 8%,60%\nwait-ready\nexpect strokes 1\nstroke 52%,62% 55%,62%\nwait-ready\nexpect strokes "
            "2\nclick Done\nwait 0.2\n" +
            look + "done.png\nexpect model\n",
        "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const int middle = 284 + (1280 - 284 - 252) / 2;
    EXPECT_LT(red(path("side.png"), 290, middle - 4), 20);
    EXPECT_GT(red(path("side.png"), middle + 4, 960), 100);
    EXPECT_LT(red(path("old.png"), 290, 940), 20);
    EXPECT_GT(red(path("new.png"), 380, 960), 100);
    EXPECT_GT(red(path("done.png"), 290, 960), 100);
}

// An ink of the work's own that no stroke uses any more comes back with a stroke that does.
TEST_F(Views, AStrokeInAnInkOfOnesOwnComesBackAfterItWasTheOnlyOne) {
    const Ran ran =
        studio(kBowl +
               "set ink gamboge\nset tip-ink cinnabar\nset two-inks on\nset pressure 0.8\nstroke 44%,54% 47%,62% "
               "52%,64%\nwait-ready\nset tool pick\nmove 47%,62%\npress\nrelease\nwait-ready\nwait 0.1\n"
               "expect message mixture\nset two-inks off\nstroke 55%,57% 60%,58%\nwait-ready\nexpect strokes 5\nclick "
               "\"stroke 5\"\nwait-ready\nclick Delete\nwait-ready\nexpect strokes 4\nclick \"stroke "
               "1\"\nwait-ready\nclick Hide\nwait-ready\n"
               "undo\nundo\nwait-ready\nexpect strokes 5\nexpect kept\n");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(Views, TheGuideAdvancesWithEachActionAndCanBeSkipped) {
    const Ran guided = studio(
        kBowl +
            "set guide on\nwait 0.1\nexpect label \"Skip the guide\"\nmove 50%,80%\npress middle\nmove 60%,80%\nmove "
            "70%,80%\nrelease middle\nwait 0.2\nmove 50%,70%\nscroll 3\nwait 0.2\nclick goat-small\nwait 0.2\n"
            "stroke 46%,60% 52%,62%\nwait-ready\nwait 0.2\nundo\nwait-ready\nwait 0.2\nexpect label Done\nclick "
            "Done\nwait 0.2\nnames\n",
        "--headless --size 1280x720");
    ASSERT_EQ(guided.status, 0) << guided.err;
    EXPECT_EQ(guided.out.find("Skip the guide"), std::string::npos);
    EXPECT_NE(read(path("state") + "/tuft/settings").find("guide_seen 1"), std::string::npos);
    fs::remove_all(path("state"));
    const Ran skipped =
        studio(kBowl +
               "wait 0.2\nplaces\nreport\nclick Help\nwait 0.1\nclick \"The first minute, step by "
               "step\"\nwait 0.2\nplaces\nreport\nclick \"Skip the guide\"\nwait 0.2\nplaces\nreport\n");
    ASSERT_EQ(skipped.status, 0) << skipped.err;
    const auto turns = places_in_turn(skipped.out);
    ASSERT_EQ(turns.size(), 3u);
    EXPECT_FALSE(turns[0].contains("Skip the guide")) << "it comes over no script";
    EXPECT_TRUE(turns[1].contains("Skip the guide"));
    EXPECT_FALSE(turns[2].contains("Skip the guide"));
}

// A box of 60 × 40 × 20 mm, painted and then moved by 200 mm.
TEST_F(Views, TheCameraFollowsARevisedModelThatMovedAndTheMotionIsNamed) {
    const auto write_box = [this](const std::string& name, double shift) {
        std::ofstream out(path(name));
        for (const int z : {0, 20})
            for (const int y : {0, 40})
                for (const int x : {0, 60}) out << "v " << x + shift << ' ' << y << ' ' << z << '\n';
        out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    };
    write_box("former.obj", 0);
    write_box("moved.obj", 200);
    const Ran ran = studio("open " + path("former.obj") +
                               "\nwait-ready\nset texels 256\nclick \"Unwrap and paint\"\nwait-ready\n"
                               "stroke 48%,55% 52%,55%\nwait-ready\nexpect strokes 1\nsave "
                               "work.tuft\nwait-ready\nreport\nrevise " +
                               path("moved.obj") +
                               "\nwait-ready\nset texels 256\nclick \"Unwrap and repaint\"\nwait-ready\n"
                               "expect message \"shifted by (200.0, 0.0, 0.0) mm\"\nreport\n",
                           "--headless --size 1280x720");
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::istringstream lines(ran.out);
    std::string first, second;
    ASSERT_TRUE(std::getline(lines, first) && std::getline(lines, second)) << ran.out;
    const nlohmann::json before = nlohmann::json::parse(first), after = nlohmann::json::parse(second);
    EXPECT_NEAR(after["target_mm"][0].get<double>() - before["target_mm"][0].get<double>(), 200, 0.01)
        << "of figures with three decimals";
    EXPECT_EQ(after["target_mm"][1], before["target_mm"][1]);
    EXPECT_EQ(after["distance_mm"], before["distance_mm"]);
}

TEST_F(Views, TheManualIsInTheHelpMenu) {
    const Ran ran = studio(
        "wait 0.2\nclick Help\nwait 0.1\nclick Manual\nwait 0.2\nclick \"page Ink\"\nwait 0.2\nexpect label \"page "
        "First steps\"\nkey escape\nwait 0.2\nnames\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out.find("page Ink"), std::string::npos);
}

TEST(Manual, EveryPageIsThereInBothLanguagesWithTheKeysThatAreSet) {
    KeyTable keys;
    keys.assign(Action::undo, *chord_of("Ctrl+U"));
    EXPECT_GE(manual_pages().size(), 8u);
    for (const ManualPage& page : manual_pages())
        for (const Language language : {Language::english, Language::chinese}) {
            const std::string text = manual_text(page, language, keys);
            EXPECT_GT(text.size(), 150u) << page.title;
            EXPECT_EQ(text.find('{'), std::string::npos) << page.title;
            EXPECT_EQ(text.find('?'), std::string::npos) << page.title << ": a key of no action\n" << text;
            EXPECT_EQ(std::count(text.begin(), text.end(), '\n'),
                      std::count(page.text, page.text + std::string(page.text).size(), '\n'))
                << "the same points: " << page.title;
        }
    EXPECT_NE(manual_text(manual_pages().front(), Language::english, keys).find("Ctrl+U"), std::string::npos);
}

}  // namespace
}  // namespace tuft::app
