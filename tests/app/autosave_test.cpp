#include "app/document/autosave.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "app/document/pictures/state_folder.h"
#include "models.h"

namespace tuft::app {
namespace {

/// A state folder of its own while it lives.
class OwnStateFolder {
  public:
    OwnStateFolder() {
        if (const char* before = std::getenv("XDG_STATE_HOME")) before_ = before;
        setenv("XDG_STATE_HOME", path_.c_str(), 1);
    }
    ~OwnStateFolder() {
        std::filesystem::remove_all(path_);
        if (before_)
            setenv("XDG_STATE_HOME", before_->c_str(), 1);
        else
            unsetenv("XDG_STATE_HOME");
    }
    OwnStateFolder(const OwnStateFolder&) = delete;
    OwnStateFolder& operator=(const OwnStateFolder&) = delete;

  private:
    const std::filesystem::path path_ =
        std::filesystem::path(testing::TempDir()) / ("tuft_lost_" + std::to_string(getpid()));
    std::optional<std::string> before_;
};

TEST(LostWork, TheLatestIsOfferedFirst) {
    namespace fs = std::filesystem;
    const OwnStateFolder state;
    const fs::path sessions = state_folder() / "sessions";
    fs::create_directories(sessions);
    const auto now = fs::file_time_type::clock::now();
    const std::vector<int> hours_ago{3, 0, 5, 1, 4, 2};  // 720 orders: that of the folder is another one
    for (const int hours : hours_ago) {
        const fs::path project = sessions / (std::to_string(hours) + ".tuft");
        std::ofstream(project) << "x";
        fs::last_write_time(project, now - std::chrono::hours(hours));
        std::ofstream(sessions / (std::to_string(9 - hours) + ".note")) << project.string() << "\nbowl.ply\n";
    }
    const std::vector<LostWork> lost = find_lost_work();
    ASSERT_EQ(lost.size(), hours_ago.size());
    for (std::size_t i = 0; i < lost.size(); ++i) EXPECT_EQ(lost[i].project.stem(), std::to_string(i));
    EXPECT_EQ(lost[0].changed - lost[2].changed, 2 * 3600);
}

/// No file may grow beyond `bytes` while it lives, as on a full disk.
class FullDisk {
  public:
    explicit FullDisk(std::uintmax_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit full = before_;
        full.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &full);
    }
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

  private:
    rlimit before_{};
};

class AutosaveTest : public testing::Test {
  protected:
    void SetUp() override {
        std::signal(SIGXFSZ, SIG_IGN);
        folder_ = std::filesystem::path(testing::TempDir()) / ("tuft_keeper_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        path_ = folder_ / "work.tuft";
        ASSERT_TRUE(autosave_.start(path_, "sheet.ply", {}, painting_).empty());
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void paint(double y) {
        autosave_.prepare(painting_, "wolf-small", "carbon");
        stroke::PaintStroke stroke;
        stroke.trace.flat = false;
        stroke.brush = "wolf-small";
        stroke.ink = "carbon";
        painting_.begin(std::move(stroke));
        painting_.extend(test::poses_above(model_, painting_.materials().brush("wolf-small"), 0.02, y));
        painting_.end();
        autosave_.add(painting_.journal().entries().back());
    }
    const stroke::Model model_ = test::shipped_model("sheet.ply", 256);
    stroke::Document painting_{model_};
    Autosave autosave_;
    std::filesystem::path folder_, path_;
};

TEST_F(AutosaveTest, AFullDiskLosesNothingOnceThereIsSpace) {
    paint(0);
    EXPECT_TRUE(autosave_.trouble().empty());

    {
        const FullDisk disk(std::filesystem::file_size(path_));
        for (int i = 1; i <= 6; ++i) paint(0.002 * i);
    }
    EXPECT_FALSE(autosave_.trouble().empty());
    EXPECT_GE(autosave_.waiting(), 1u);

    paint(0.02);
    EXPECT_TRUE(autosave_.trouble().empty());
    EXPECT_EQ(autosave_.waiting(), 0u);
    EXPECT_EQ(io::Project::open(path_).strokes().size(), painting_.journal().entries().size());
}

TEST_F(AutosaveTest, AFailedSaveKeepsTheFormerProject) {
    EXPECT_FALSE(autosave_.start(folder_ / "no such folder" / "x.tuft", "sheet.ply", {}, painting_).empty());
    EXPECT_EQ(autosave_.path(), path_);
    paint(0);
    EXPECT_TRUE(autosave_.trouble().empty());
    EXPECT_EQ(io::Project::open(path_).strokes().size(), 1u);
}

// No folder can be written into when the work begins: it waits in memory, and is in its file as soon as there can be
// one.
TEST_F(AutosaveTest, WorkThatHasNoFileYetWaitsForOne) {
    Autosave autosave;
    const auto file = folder_ / "later" / "work.tuft";
    const Message fault = autosave.start(file, "sheet.ply", {}, painting_);
    ASSERT_FALSE(fault.empty());
    autosave.start_later(file, "sheet.ply", {}, fault);
    std::swap(autosave, autosave_);
    for (int i = 0; i < 3; ++i) paint(0.002 * i);
    const std::uint64_t gone = painting_.journal().entries().back().id;
    painting_.undo();
    autosave_.remove(gone);
    EXPECT_EQ(autosave_.trouble(), fault);
    EXPECT_EQ(autosave_.waiting(), 2u);
    EXPECT_TRUE(autosave_.path().empty());

    std::filesystem::create_directories(file.parent_path());
    paint(0.02);
    EXPECT_TRUE(autosave_.trouble().empty());
    EXPECT_EQ(autosave_.waiting(), 0u);
    EXPECT_EQ(autosave_.path(), file);
    const auto kept = io::Project::open(file).strokes();
    ASSERT_EQ(kept.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(kept[i].id, painting_.journal().entries()[i].id);
}

// Texels are never stored beside a journal that they do not show.
TEST_F(AutosaveTest, AChangeThatCannotBeWrittenKeepsTexelsAway) {
    for (int i = 0; i < 3; ++i) paint(0.002 * i);
    const std::uint64_t gone = painting_.journal().entries().back().id;
    painting_.undo();
    {
        const FullDisk disk(0);
        autosave_.remove(gone);
    }
    EXPECT_TRUE(autosave_.behind());
    paint(0.02);
    EXPECT_FALSE(autosave_.trouble().empty()) << "one stroke too many is in the file";
    autosave_.store_canvas(painting_);
    EXPECT_FALSE(io::Project::open(path_).load_canvas(model_.texels.n_slots()));
    autosave_.rewrite("sheet.ply", {}, painting_);
    EXPECT_FALSE(autosave_.behind());
    EXPECT_TRUE(autosave_.trouble().empty());
    EXPECT_EQ(io::Project::open(path_).strokes().size(), 3u);
    EXPECT_TRUE(io::Project::open(path_).load_canvas(model_.texels.n_slots()));
}

// A change of a stroke in the middle writes the file anew: when the disk gets full over that, the strokes of before
// must still be in it.
TEST_F(AutosaveTest, AFileWrittenAnewOnAFullDiskKeepsItsStrokes) {
    for (int i = 0; i < 8; ++i) paint(0.002 * i);
    std::string fault, elsewhere;
    {
        // Room for the model, and for the strokes but for two pages of the file.
        const FullDisk disk(std::filesystem::file_size(path_) - 8192);
        fault = autosave_.start(path_, "sheet.ply", {}, painting_).text();
        elsewhere = autosave_.start(folder_ / "other.tuft", "sheet.ply", {}, painting_).text();
    }
    EXPECT_NE(fault.find("work.tuft"), std::string::npos) << fault;
    EXPECT_EQ(fault.find(".part"), std::string::npos) << fault;
    EXPECT_NE(elsewhere, "");
    EXPECT_EQ(io::Project::open(path_).strokes().size(), 8u);
    // Nothing half done lies about.
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        EXPECT_TRUE(entry.path() == path_ || entry.path().extension() == ".lock") << entry.path();
    }
    paint(0.02);
    EXPECT_EQ(io::Project::open(path_).strokes().size(), 9u);
}

TEST_F(AutosaveTest, AttachmentsAreInEachOfItsFiles) {
    const io::Attachment image{"0001", R"({"name":"leaf.png"})", {'a', 'b'}}, other{"0002", "{}", {}};
    autosave_.attach(io::kReferences, image);
    autosave_.attach(io::kReferences, other);
    autosave_.attach(io::kSnapshots, image);
    autosave_.detach(io::kReferences, "0002");
    EXPECT_TRUE(autosave_.start(folder_ / "named.tuft", "sheet.ply", {}, painting_).empty());
    for (const auto& file : {path_, folder_ / "named.tuft"}) {
        EXPECT_EQ(io::Project::open(file).attachments(io::kReferences), std::vector<io::Attachment>{image}) << file;
        EXPECT_EQ(io::Project::open(file).attachments(io::kSnapshots), std::vector<io::Attachment>{image}) << file;
    }
    // A full disk keeps it out of the file until there is room.
    std::vector<char> noise(100'000);  // which does not compress
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<char>(i * i * 2654435761u >> 13);
    {
        const FullDisk disk(std::filesystem::file_size(folder_ / "named.tuft"));
        autosave_.attach(io::kReferences, {"0003", "{}", noise});
    }
    EXPECT_FALSE(autosave_.trouble().empty());
    EXPECT_TRUE(autosave_.behind());
    autosave_.rewrite("sheet.ply", {}, painting_);
    EXPECT_TRUE(autosave_.trouble().empty());
    EXPECT_EQ(io::Project::open(folder_ / "named.tuft").attachments(io::kReferences).size(), 2u);
}

}  // namespace
}  // namespace tuft::app
