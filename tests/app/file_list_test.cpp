#include "app/widgets/file_list.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

namespace tuft::app {
namespace {

namespace fs = std::filesystem;

std::string names(const std::vector<FileEntry>& entries) {
    std::string all;
    for (const FileEntry& e : entries) all += e.name + " ";
    return all;
}

TEST(FileList, FoldersComeFirstAndFilesInTheOrderAskedFor) {
    std::vector<FileEntry> entries{{"b.ply", false, 30, 100},
                                   {"Zebra", true, 0, 5},
                                   {"A.ply", false, 10, 300},
                                   {"apes", true, 0, 9},
                                   {"c.ply", false, 20, 200}};
    const std::tuple<FileOrder, bool, const char*> orders[] = {
        {FileOrder::name, false, "apes Zebra A.ply b.ply c.ply "},
        {FileOrder::name, true, "apes Zebra c.ply b.ply A.ply "},
        {FileOrder::size, false, "apes Zebra A.ply c.ply b.ply "},
        {FileOrder::date, true, "apes Zebra A.ply c.ply b.ply "},
        {FileOrder::date, false, "apes Zebra b.ply c.ply A.ply "}};
    for (const auto& [order, downward, expected] : orders) {
        sort_entries(entries, order, downward);
        EXPECT_EQ(names(entries), expected) << static_cast<int>(order) << downward;
    }
}

TEST(FileList, AFilterIgnoresCase) {
    EXPECT_TRUE(matches_filter("Bowl-Fired.tuft", "fired"));
    EXPECT_TRUE(matches_filter("bowl.tuft", ""));
    EXPECT_FALSE(matches_filter("bowl.tuft", "vase"));
}

TEST(FileList, AFolderIsReadWithoutHiddenFilesPipesAndWhatDoesNotSuit) {
    const fs::path folder = fs::path(testing::TempDir()) / ("tuft_list_" + std::to_string(getpid()));
    fs::create_directories(folder / "inner");
    for (const char* name : {"a.ply", "b.txt", ".c.ply"}) std::ofstream(folder / name) << "12345";
    ASSERT_EQ(mkfifo((folder / "pipe.ply").c_str(), 0600), 0);
    Message fault = "left over";
    std::vector<FileEntry> entries = list_folder(
        folder, [](const fs::path& p) { return p.extension() == ".ply"; }, fault);
    sort_entries(entries, FileOrder::name, false);
    EXPECT_EQ(names(entries), "inner a.ply ");
    EXPECT_TRUE(fault.empty()) << fault.text();
    EXPECT_EQ(entries.back().bytes, 5u);
    EXPECT_EQ(date_text(entries.back().changed).size(), 16u);
    list_folder(
        folder / "missing", [](const fs::path&) { return true; }, fault);
    EXPECT_FALSE(fault.empty());
    fs::remove_all(folder);
}

TEST(FileList, SizesAreRoundedUpToAKilobyte) {
    EXPECT_EQ(size_text(1), "1 kB");
    EXPECT_EQ(size_text(4096), "4 kB");
    EXPECT_EQ(size_text(3 << 20), "3.0 MB");
}

}  // namespace
}  // namespace tuft::app
