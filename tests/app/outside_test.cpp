#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>
#include <thread>

#include "app/document/writing.h"
#include "app/paint/paint_thread.h"
#include "ink/colour/pigments.h"
#include "io/project/project.h"
#include "io/project/restore.h"
#include "models.h"
#include "paths.h"
#include "studio_program.h"

/// Other programs that change the project while it is open: nothing is lost on either side.
namespace tuft::app {
namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 60;  // seconds until something that must happen is given up; it takes one or two

class OutsideChangesTest : public testing::Test {
  protected:
    void SetUp() override { open("sheet.ply"); }
    void open(const std::string& model) {
        model_ = model;
        folder_ = fs::path(testing::TempDir()) / ("tuft_outside_" + std::to_string(getpid()));
        fs::create_directories(folder_ / "place");
        path_ = folder_ / "place" / "work.tuft";
        PaintWork work;
        work.model = std::make_unique<stroke::Model>(test::shipped_model(model_, 256));
        work.document = std::make_unique<stroke::Document>(*work.model);
        work.texture = std::make_unique<Texture>(*work.document, ProgressFn{});
        work.spare = folder_ / "spare.tuft";
        ASSERT_TRUE(work.autosave.start(path_, model_, {}, *work.document).empty());
        painter_ = std::make_unique<PaintThread>(std::move(work));
    }
    void TearDown() override {
        painter_.reset();
        fs::remove_all(folder_);
    }

    void stroke(double y, const std::string& ink = "carbon") {
        const brush::Preset preset = brush::load_preset("wolf-small");
        painter_->post(BeginStroke{.brush = "wolf-small", .ink = ink});
        painter_->post(ExtendStroke{test::poses_above(painter_->model(), preset, 0.02, y)});
        painter_->post(EndStroke{});
        rest();
    }
    void look() {
        Update u = painter_->take();
        if (u.events.strokes) lines_ = std::move(*u.events.strokes);
        for (const Message& m : u.events.messages) messages_ += m.text() + '\n';
        last_ = std::move(u);
    }
    void rest() {
        painter_->wait_idle(100);
        look();
    }
    bool comes(const std::function<bool()>& what) {
        for (double t = 0; t < kLongest; t += 0.05) {
            look();
            if (what()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return false;
    }
    // A program of before: it takes no lock, but it does as SQLite wants.
    void as_old_program(const std::string& sql) { SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec(sql); }
    void expect_file(std::size_t strokes, const fs::path& file) {
        const io::Project project = io::Project::open(file, {.access = io::Access::read});
        ASSERT_EQ(project.n_strokes(), strokes);
        const stroke::Model model = test::shipped_model(model_, 256);
        stroke::Document opened(model), replayed(model);
        for (stroke::Document* p : {&opened, &replayed}) io::use_presets(project, *p);
        io::restore_strokes(project, opened, {});
        replayed.replay(project.strokes());
        EXPECT_EQ(opened.layers().hash(), replayed.layers().hash());
    }

    fs::path folder_, path_;
    std::string model_;
    std::unique_ptr<PaintThread> painter_;
    std::vector<StrokeLine> lines_;
    std::string messages_;
    Update last_;
};

// The file gets a copy of the first stroke 5 mm aside, under the id that the next one here would have.
const std::string kCopyFirst =
    "INSERT INTO strokes(id, brush, ink, seed, label, settings, hidden, flat, laying, placement, sample_count, "
    "samples) "
    "SELECT (SELECT max(id) + 1 FROM strokes), brush, ink, seed, 'theirs', settings, hidden, flat, laying, placement, "
    "sample_count, samples "
    "FROM strokes LIMIT 1";

TEST_F(OutsideChangesTest, AChangeIsNoticedWithoutAStrokeAndPaintingContinuesAfterIt) {
    stroke(0);
    as_old_program(kCopyFirst);
    EXPECT_TRUE(comes([&] {
        return messages_.find("Another program changed this project; 1 change of it is taken in.") != std::string::npos;
    })) << messages_;
    EXPECT_EQ(lines_.size(), 2u);
    stroke(0.01);
    EXPECT_TRUE(last_.status.file.trouble.empty());
    painter_.reset();
    expect_file(3, path_);
}

// No time to notice it before the stroke is to be written.
TEST_F(OutsideChangesTest, AStrokeThatMeetsAChangeIsPaintedAfterIt) {
    stroke(0);
    for (int i = 1; i <= 3; ++i) {
        as_old_program(kCopyFirst);
        stroke(0.01 * i);
        EXPECT_TRUE(comes([&] {
            return lines_.size() == 1u + 2u * static_cast<unsigned>(i) && last_.status.file.unsaved == 0 &&
                   last_.status.file.trouble.empty();
        })) << last_.status.file.trouble.text();
    }
    painter_->post(UndoStroke{});
    rest();
    EXPECT_EQ(lines_.size(), 6u);
    painter_.reset();
    expect_file(6, path_);
}

class OutsideChangesOfASphere : public OutsideChangesTest {
    void SetUp() override { open("sphere.ply"); }
};

// The other program mixed a colour by its own pigments, here as cinnabar. A search would find another mix.
TEST_F(OutsideChangesOfASphere, AnInkOfTheOtherProgramStaysWhereADrawingInItIsRefused) {
    const std::string colour = "#1b6f5a";
    const std::string toml = std::regex_replace(ink::ink_toml(ink::load_ink("cinnabar")), std::regex("'"), "''");
    stroke(0);
    as_old_program("BEGIN; INSERT INTO presets VALUES('ink', '" + colour + "', '" + toml + "'); " + kCopyFirst +
                   "; UPDATE strokes SET ink = '" + colour + "' WHERE label = 'theirs'; COMMIT");
    ASSERT_TRUE(comes([&] { return lines_.size() == 2 && last_.status.file.unsaved == 0; }));
    // A line 1.4 m long by a tuft that is longer than the sphere.
    const std::string line = (folder_ / "line.inkml").string();
    std::ofstream(line) << "<ink xmlns='http://www.w3.org/2003/InkML'><trace>0 0, 7 0, 14 0</trace></ink>";
    Writing writing = read_writing(line);
    writing.scale = 100;
    const stroke::Placement place = stroke::placement_seen({0, 0, 0.05}, {0, 0, 1}, {1, 0, 0}, 0);
    painter_->post(PaintDrawing{placed_writing(writing, place, {"wolf-large*4", colour}), {}});
    rest();
    EXPECT_NE(messages_.find("does not suit the drawing"), std::string::npos) << messages_;
    stroke(0.01, colour);
    painter_.reset();
    expect_file(3, path_);
}

TEST_F(OutsideChangesTest, AnUndoThatMeetsAChangeTakesBackWhatIsItsOwn) {
    stroke(0);
    stroke(0.01);
    as_old_program(kCopyFirst);
    painter_->post(UndoStroke{});
    rest();
    EXPECT_TRUE(
        comes([&] { return lines_.size() == 2 && lines_[1].label == "theirs" && last_.status.file.trouble.empty(); }));
    painter_.reset();
    expect_file(2, path_);
}

// As `tuft replay --project` of before did over an open project: with the same strokes and one more.
TEST_F(OutsideChangesTest, AFilePutInThePlaceOfTheProjectIsTakenIn) {
    stroke(0);
    fs::copy_file(path_, folder_ / "other.tuft");
    SQLite::Database((folder_ / "other.tuft").string(), SQLite::OPEN_READWRITE).exec(kCopyFirst);
    fs::rename(folder_ / "other.tuft", path_);
    stroke(0.01);
    EXPECT_TRUE(comes([&] { return lines_.size() == 3 && last_.status.file.trouble.empty(); }))
        << last_.status.file.trouble.text();
    painter_.reset();
    expect_file(3, path_);
}

TEST_F(OutsideChangesTest, WhereAnotherModelIsPutInItsPlaceTheWorkGoesOnInACopy) {
    stroke(0);
    {
        const stroke::Model other = test::shipped_model("sphere.ply", 256);
        stroke::Document painting(other);
        Autosave autosave;
        ASSERT_TRUE(autosave.start(folder_ / "other.tuft", "sphere.ply", {}, painting).empty());
    }
    const auto size = fs::file_size(folder_ / "other.tuft");
    fs::rename(folder_ / "other.tuft", path_);
    stroke(0.01);
    EXPECT_TRUE(comes([&] {
        return last_.status.file.project == folder_ / "spare.tuft" && last_.status.file.trouble.empty();
    })) << last_.status.file.trouble.text();
    painter_.reset();
    expect_file(2, folder_ / "spare.tuft");
    EXPECT_EQ(fs::file_size(path_), size) << "theirs is as it was";
}

// The folder is gone to the end: what is in memory goes where it can, and that is said.
TEST_F(OutsideChangesTest, AtTheEndWorkThatItsOwnFileCannotTakeIsInTheSpareOne) {
    stroke(0);
    fs::rename(folder_ / "place", folder_ / "elsewhere");
    stroke(0.01);
    EXPECT_EQ(last_.status.file.unsaved, 1u);
    EXPECT_NE(last_.status.file.trouble.text().find("is not there any more"), std::string::npos);
    EXPECT_EQ(painter_->finish(), folder_ / "spare.tuft");
    expect_file(2, folder_ / "spare.tuft");
}

TEST_F(OutsideChangesTest, AtTheEndAFolderThatCameBackIsEnough) {
    stroke(0);
    fs::rename(folder_ / "place", folder_ / "elsewhere");
    stroke(0.01);
    fs::rename(folder_ / "elsewhere", folder_ / "place");
    EXPECT_EQ(painter_->finish(), "");
    EXPECT_FALSE(painter_->unsaved());
    expect_file(2, path_);
}

/// The real programs.
class TwoPrograms : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_two_" + std::to_string(getpid()) + "_" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "place");
        const Ran made = shell(
            "'" + tuft_program() + "' paint '" + source_folder() + "/models/sheet.ply' --strokes '" + source_folder() +
            "/samples/strokes/stroke-sheet.inkml' --atlas-size 256 --quiet --project place/work.tuft");
        ASSERT_EQ(made.status, 0) << made.err;
        strokes_ = io::Project::open(folder_ / "place/work.tuft").n_strokes();
        if (const std::string lack = lack_of_opengl(); !lack.empty()) GTEST_SKIP() << lack;
    }
    void TearDown() override { fs::remove_all(folder_); }

    struct Ran {
        int status = -1;
        std::string err;
    };
    Ran shell(const std::string& command, const std::string& name = "shell") const {
        const std::string err = (folder_ / (name + ".err")).string();
        const int raw =
            std::system(("cd '" + folder_.string() + "' && TUFT_DATA='" + source_folder() + "' XDG_STATE_HOME='" +
                         (folder_ / name).string() + "' " + command + " >/dev/null 2>'" + err + "'")
                            .c_str());
        std::ifstream in(err);
        std::ostringstream text;
        text << in.rdbuf();
        return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw), text.str()};
    }
    Ran studio(const std::string& script, const std::string& name) const {
        std::ofstream(folder_ / (name + ".txt")) << script;
        return shell("'" + studio_program() + "' --headless --size 884x520 --script " + name + ".txt", name);
    }
    void wait_for(const std::string& file) const {
        for (double t = 0; t < kLongest && !fs::exists(folder_ / file); t += 0.05)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        ASSERT_TRUE(fs::exists(folder_ / file));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the picture is written to its end
    }
    std::string n(std::size_t more) const { return std::to_string(strokes_ + more); }

    fs::path folder_;
    std::size_t strokes_ = 0;
};

const std::string kStroke = "stroke 46%,48% 54%,52%\nwait-ready\n";

TEST_F(TwoPrograms, TheCommandLineNamesTheStudioAndNothingIsLost) {
    Ran one;
    std::thread first([&] {
        one = studio("open place/work.tuft\nwait-ready\nscreenshot ready.png\nwait 4\n" + kStroke + "expect strokes " +
                         n(1) + "\nexpect kept\n",
                     "one");
    });
    wait_for("ready.png");
    const Ran fill = shell("'" + tuft_program() + "' fill place/work.tuft --ink cinnabar");
    const Ran again = shell("'" + tuft_program() + "' replay place/work.tuft --project place/work.tuft");
    const Ran reads = shell("'" + tuft_program() + "' export place/work.tuft -o a.png");
    first.join();
    for (const Ran& r : {fill, again}) {
        EXPECT_EQ(r.status, 1);
        EXPECT_NE(r.err.find("work.tuft: tuft-studio (process "), std::string::npos) << r.err;
        EXPECT_NE(r.err.find("close it there, or work on a copy"), std::string::npos) << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    }
    EXPECT_EQ(reads.status, 0) << reads.err;
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(io::Project::open(folder_ / "place/work.tuft").n_strokes(), strokes_ + 1);
    EXPECT_EQ(shell("'" + tuft_program() + "' fill place/work.tuft --ink cinnabar").status, 0) << "free again";
}

TEST_F(TwoPrograms, ASecondWindowAsksAndItsViewFollowsTheFirst) {
    Ran one, two;
    std::thread first([&] {
        one = studio("open place/work.tuft\nwait-ready\nscreenshot ready.png\nwait 6\n" + kStroke +
                         "expect kept\nwait 4\nexpect strokes " + n(1) + "\n",
                     "one");
    });
    wait_for("ready.png");
    two = studio("open place/work.tuft\nawait label \"Look at it\"\nclick \"Look at it\"\nwait-ready\nexpect strokes " +
                     n(0) + "\n" + kStroke + "expect strokes " + n(0) +
                     "\nexpect message \"only looked at\"\nawait strokes " + n(1) +
                     // A button that acted would replace the palette's message.
                     "\nwait-ready\nkey p\nwait 0.2\nexpect message \"Pour inks\"\nclick Wash\nclick \"Rinse the "
                     "brush\"\nwait 0.3\nexpect message \"Pour inks\"\nopen ready.png\nwait 0.2\nexpect message "
                     "\"only looked at\"\nkey p\nwait 0.2\nset tool text\nset text \xe6\xb0\xb8\nwait-ready\nmove "
                     "50%,54%\nwait 0.1\npress\nrelease\nwait-ready\nexpect strokes " +
                     n(1) +
                     "\nset tool brush\nsave copy.tuft\nwait-ready\nstroke 46%,52% "
                     "54%,56%\nwait-ready\nexpect strokes " +
                     n(2) + "\nexpect kept\n",
                 "two");
    first.join();
    EXPECT_EQ(two.status, 0) << two.err;
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(io::Project::open(folder_ / "place/work.tuft").n_strokes(), strokes_ + 1);
    EXPECT_EQ(io::Project::open(folder_ / "copy.tuft").n_strokes(), strokes_ + 2);
}

TEST_F(TwoPrograms, QuittingAsksWhereWorkIsNotOnDiskAndOffersItLater) {
    Ran one;
    std::thread second([&] {
        one =
            studio("open place/work.tuft\nwait-ready\nscreenshot ready.png\nwait 2\n" + kStroke +
                       "quit\nwait 0.3\nexpect label \"Leave all the same\"\nclick \"Go back\"\nwait 0.2\nquit\nawait "
                       "label \"Try again\"\nclick \"Try again\"\nwait 0.5\n"
                       "expect label \"Leave all the same\"\nclick \"Leave all the same\"\nwait 5\nexpect strokes 0\n",
                   "one");
    });
    wait_for("ready.png");
    fs::rename(folder_ / "place", folder_ / "elsewhere");
    second.join();
    EXPECT_EQ(one.status, 1);
    EXPECT_NE(one.err.find("could not be written; the work is in "), std::string::npos) << one.err;
    const Ran next =
        studio("await label Continue\nclick Continue\nwait 0.2\nwait-ready\nexpect strokes " + n(1) + "\nexpect kept\n",
               "one");
    EXPECT_EQ(next.status, 0) << next.err;
}

}  // namespace
}  // namespace tuft::app
