#include "app/state/brush_shelf.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "brush/preset/preset.h"

namespace tuft::app {
namespace {

namespace fs = std::filesystem;

/// The file of a brush of one's own.
class OwnBrush : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_shelf_" + std::to_string(getpid()));
        fs::create_directories(folder_);
        file_ = (folder_ / "mine.toml").string();
        write(0.02);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// With hair of that length, metres, at a time of its own.
    void write(double length) {
        brush::Preset preset = brush::load_preset("wolf-small");
        preset.length = length;
        std::ofstream(file_) << brush::preset_toml(preset);
        fs::last_write_time(file_, start_ + std::chrono::seconds(++written_));
    }
    double length() { return shelf_.at(file_).preset.length; }

    fs::path folder_;
    std::string file_;
    BrushShelf shelf_;
    const fs::file_time_type start_ = fs::file_time_type::clock::now();
    int written_ = 0;
};

constexpr double kExact = 1e-9;  // metres: TOML states so many digits

TEST_F(OwnBrush, IsReadAgainOnlyWhenItsFileChanges) {
    EXPECT_NEAR(length(), 0.02, kExact);
    const std::uint64_t first = shelf_.at(file_).reading;
    shelf_.look();
    EXPECT_EQ(shelf_.at(file_).reading, first);
    write(0.03);
    EXPECT_NEAR(length(), 0.02, kExact) << "until one looks";
    shelf_.look();
    EXPECT_NEAR(length(), 0.03, kExact);
    EXPECT_NE(shelf_.at(file_).reading, first);
}

TEST_F(OwnBrush, ThatIsAwayLooksAsItDidAndIsBackWithItsFile) {
    EXPECT_TRUE(shelf_.at(file_).fault.empty());
    fs::rename(file_, file_ + ".away");
    shelf_.look();
    EXPECT_NE(shelf_.at(file_).fault.text().find(file_), std::string::npos);
    EXPECT_FALSE(shelf_.at(file_).written);
    EXPECT_NEAR(length(), 0.02, kExact);
    fs::rename(file_ + ".away", file_);
    shelf_.look();
    EXPECT_TRUE(shelf_.at(file_).fault.empty()) << shelf_.at(file_).fault.text();
}

TEST_F(OwnBrush, ThatIsDamagedSaysWhereAndWhenItIsMendedItIsWhole) {
    std::ofstream(file_) << "[shape]\nlength_mm = long\n";
    fs::last_write_time(file_, start_ + std::chrono::seconds(100));
    EXPECT_NE(shelf_.at(file_).fault.text().find("2"), std::string::npos) << shelf_.at(file_).fault.text();
    EXPECT_TRUE(shelf_.at(file_).written);
    write(0.025);
    shelf_.look();
    EXPECT_TRUE(shelf_.at(file_).fault.empty());
    EXPECT_NEAR(length(), 0.025, kExact);
}

TEST_F(OwnBrush, HangsInAFamilyThatIsMadeAnewOnlyWhereSomethingChanged) {
    const std::vector<std::string> names{"wolf-medium", "wolf-small", file_, "goat-small"};
    const std::vector<BrushFamily>& families = shelf_.families(names);
    ASSERT_EQ(families.size(), 3u);
    EXPECT_EQ(families[0].title, "goat");
    EXPECT_EQ(families[1].names, (std::vector<std::string>{"wolf-small", "wolf-medium"}));
    EXPECT_EQ(families[2].names, std::vector<std::string>{file_});
    const BrushFamily* there = families.data();
    EXPECT_EQ(shelf_.families(names).data(), there);
    EXPECT_EQ(shelf_.families({names[0]}).size(), 1u);
    fs::remove(file_);
    shelf_.look();
    EXPECT_EQ(shelf_.families(names).back().names, std::vector<std::string>{file_}) << "away, in its place";
}

}  // namespace
}  // namespace tuft::app
