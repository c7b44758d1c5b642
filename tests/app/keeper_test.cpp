#include "app/keeper.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "models.h"

namespace tuft::app {
namespace {

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

class KeeperTest : public testing::Test {
  protected:
    void SetUp() override {
        std::signal(SIGXFSZ, SIG_IGN);
        folder_ = std::filesystem::path(testing::TempDir()) / ("tuft_keeper_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void paint(stroke::Painting& painting, Keeper& keeper, double y) {
        keeper.prepare(painting, "wolf-small", "carbon");
        stroke::Stroke stroke;
        stroke.trace.flat = false;
        stroke.trace.brush = "wolf-small";
        stroke.trace.ink = "carbon";
        painting.begin(std::move(stroke));
        painting.extend(test::poses_above(painting.model(), painting.brush("wolf-small"), 0.02, y));
        painting.end();
        keeper.add(painting.journal().strokes().back());
    }
    std::filesystem::path folder_;
};

TEST_F(KeeperTest, AFullDiskLosesNothingThatRoomCanBring) {
    const stroke::Model model = test::shipped_model("sheet.ply", 256);
    stroke::Painting painting(model);
    Keeper keeper;
    const auto path = folder_ / "work.tuft";
    ASSERT_EQ(keeper.start(path, "sheet.ply", {}, painting), "");
    paint(painting, keeper, 0);
    EXPECT_EQ(keeper.trouble(), "");

    {
        const FullDisk disk(std::filesystem::file_size(path));
        for (int i = 1; i <= 6; ++i) paint(painting, keeper, 0.002 * i);
    }
    EXPECT_NE(keeper.trouble(), "");
    EXPECT_GE(keeper.waiting(), 1u);

    paint(painting, keeper, 0.02);
    EXPECT_EQ(keeper.trouble(), "");
    EXPECT_EQ(keeper.waiting(), 0u);
    EXPECT_EQ(io::Project::open(path).strokes().size(), painting.journal().strokes().size());
}

TEST_F(KeeperTest, AFailedSaveKeepsTheFormerProject) {
    const stroke::Model model = test::shipped_model("sheet.ply", 256);
    stroke::Painting painting(model);
    Keeper keeper;
    const auto path = folder_ / "work.tuft";
    ASSERT_EQ(keeper.start(path, "sheet.ply", {}, painting), "");
    EXPECT_NE(keeper.start(folder_ / "no such folder" / "x.tuft", "sheet.ply", {}, painting), "");
    EXPECT_EQ(keeper.path(), path);
    paint(painting, keeper, 0);
    EXPECT_EQ(keeper.trouble(), "");
    EXPECT_EQ(io::Project::open(path).strokes().size(), 1u);
}

// Texels are never stored beside a journal that they do not show.
TEST_F(KeeperTest, AChangeThatCannotBeWrittenKeepsTexelsAway) {
    const stroke::Model model = test::shipped_model("sheet.ply", 256);
    stroke::Painting painting(model);
    Keeper keeper;
    const auto path = folder_ / "behind.tuft";
    ASSERT_EQ(keeper.start(path, "sheet.ply", {}, painting), "");
    for (int i = 0; i < 3; ++i) paint(painting, keeper, 0.002 * i);
    const std::uint64_t gone = painting.journal().strokes().back().id;
    painting.undo();
    {
        const FullDisk disk(0);
        keeper.remove(gone);
    }
    EXPECT_TRUE(keeper.behind());
    paint(painting, keeper, 0.02);
    EXPECT_NE(keeper.trouble(), "") << "one stroke too many is in the file";
    keeper.store_canvas(painting);
    EXPECT_FALSE(io::Project::open(path).load_canvas(model.texels.n_slots()));
    keeper.rewrite("sheet.ply", {}, painting);
    EXPECT_FALSE(keeper.behind());
    EXPECT_EQ(keeper.trouble(), "");
    EXPECT_EQ(io::Project::open(path).strokes().size(), 3u);
    EXPECT_TRUE(io::Project::open(path).load_canvas(model.texels.n_slots()));
}

// A change of a stroke in the middle writes the file anew: when the disk gets full over that, the strokes of before
// must still be in it.
TEST_F(KeeperTest, AFileWrittenAnewOnAFullDiskKeepsItsStrokes) {
    const stroke::Model model = test::shipped_model("sheet.ply", 256);
    stroke::Painting painting(model);
    Keeper keeper;
    const auto path = folder_ / "work.tuft";
    ASSERT_EQ(keeper.start(path, "sheet.ply", {}, painting), "");
    for (int i = 0; i < 8; ++i) paint(painting, keeper, 0.002 * i);
    std::string fault, elsewhere;
    {
        // Room for the model, and for the strokes but for two pages of the file.
        const FullDisk disk(std::filesystem::file_size(path) - 8192);
        fault = keeper.start(path, "sheet.ply", {}, painting);
        elsewhere = keeper.start(folder_ / "other.tuft", "sheet.ply", {}, painting);
    }
    EXPECT_NE(fault.find("work.tuft"), std::string::npos) << fault;
    EXPECT_EQ(fault.find(".part"), std::string::npos) << fault;
    EXPECT_NE(elsewhere, "");
    EXPECT_EQ(io::Project::open(path).strokes().size(), 8u);
    // Nothing half done lies about.
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) EXPECT_EQ(entry.path(), path);
    paint(painting, keeper, 0.02);
    EXPECT_EQ(io::Project::open(path).strokes().size(), 9u);
}

}  // namespace
}  // namespace tuft::app
