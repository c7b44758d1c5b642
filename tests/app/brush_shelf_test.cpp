#include "app/state/brush_shelf.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>

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
    void look() {
        shelf_.look();
        shelf_.wait();
        shelf_.poll();
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
    look();
    EXPECT_EQ(shelf_.at(file_).reading, first);
    write(0.03);
    shelf_.look();
    shelf_.wait();
    EXPECT_NEAR(length(), 0.02, kExact) << "until the window takes what was read";
    shelf_.poll();
    EXPECT_FALSE(shelf_.busy());
    EXPECT_NEAR(length(), 0.03, kExact);
    EXPECT_NE(shelf_.at(file_).reading, first);
}

TEST_F(OwnBrush, ThatIsMissingLooksAsItDidAndIsBackWithItsFile) {
    EXPECT_TRUE(shelf_.at(file_).fault.empty());
    fs::rename(file_, file_ + ".away");
    look();
    EXPECT_NE(shelf_.at(file_).fault.text().find(file_), std::string::npos);
    EXPECT_FALSE(shelf_.at(file_).written);
    EXPECT_NEAR(length(), 0.02, kExact);
    fs::rename(file_ + ".away", file_);
    look();
    EXPECT_TRUE(shelf_.at(file_).fault.empty()) << shelf_.at(file_).fault.text();
}

TEST_F(OwnBrush, ThatIsDamagedSaysWhereAndWhenItIsMendedItIsWhole) {
    std::ofstream(file_) << "[shape]\nlength_mm = long\n";
    fs::last_write_time(file_, start_ + std::chrono::seconds(100));
    EXPECT_NE(shelf_.at(file_).fault.text().find(file_ + ":2"), std::string::npos) << shelf_.at(file_).fault.text();
    EXPECT_TRUE(shelf_.at(file_).written);
    write(0.025);
    look();
    EXPECT_TRUE(shelf_.at(file_).fault.empty());
    EXPECT_NEAR(length(), 0.025, kExact);
}

// What a look found is older than what was read after it had begun.
TEST_F(OwnBrush, ThatIsReadDuringALookStaysAsItIs) {
    shelf_.at(file_);
    write(0.03);
    shelf_.look();
    shelf_.wait();
    write(0.04);
    shelf_.read(file_);
    shelf_.poll();
    EXPECT_NEAR(length(), 0.04, kExact);
}

TEST_F(OwnBrush, ThatIsOffTheListAndOutOfTheHandIsLetGo) {
    const std::string other = (folder_ / "other.toml").string();
    fs::copy_file(file_, other);
    for (const bool in_hand : {false, true}) {
        BrushShelf shelf;
        const std::uint64_t read = shelf.at(file_).reading, listed = shelf.at(other).reading;
        shelf.watch({other}, in_hand ? file_ : "wolf-small");
        EXPECT_EQ(shelf.at(other).reading, listed);
        EXPECT_EQ(shelf.at(file_).reading == read, in_hand) << "it is read again when it is asked for";
    }
}

// A lease (fcntl) makes who opens the file wait, as a disk does that is gone: up to 45 s, or until it is given back.
TEST_F(OwnBrush, OfADiskThatDoesNotAnswerIsNotWaitedForAtTheEnd) {
    auto shelf = std::make_unique<BrushShelf>();
    shelf->at(file_);
    write(0.03);
    const auto before = signal(SIGIO, SIG_IGN);  // by which the system informs the holder of it
    const int file = ::open(file_.c_str(), O_RDWR);
    ASSERT_GE(file, 0);
    if (::fcntl(file, F_SETLEASE, F_WRLCK) != 0) {
        ::close(file);
        signal(SIGIO, before);
        GTEST_SKIP() << "no leases on this file system";
    }
    shelf->look();
    shelf.reset();
    // Would wait still: the lease is neither given back nor has its time run out.
    const int second = ::open(file_.c_str(), O_RDONLY | O_NONBLOCK);
    EXPECT_EQ(second, -1);
    EXPECT_EQ(errno, EWOULDBLOCK);
    ::fcntl(file, F_SETLEASE, F_UNLCK);
    ::close(file);
    signal(SIGIO, before);
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
    look();
    EXPECT_EQ(shelf_.families(names).back().names, std::vector<std::string>{file_}) << "missing, in its place";
}

}  // namespace
}  // namespace tuft::app
