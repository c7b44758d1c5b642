#include "core/files/disk_cache.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>

namespace tuft {
namespace {

namespace fs = std::filesystem;

class DiskCacheTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft-cache-" + std::to_string(::getpid()) + "-" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static CacheKey key(int n) {
        CacheKey key("test 1");
        key.add(n);
        return key;
    }
    static std::vector<int> values(int n) {
        std::vector<int> all(1000);
        std::iota(all.begin(), all.end(), n);
        return all;
    }
    static bool store(const DiskCache& cache, int n) {
        return cache.write(key(n), [&](CacheWriter& entry) {
            entry.put(values(n));
            entry.put_text("text " + std::to_string(n));
        });
    }
    // True when the entry is there, and then it is the one that was stored.
    static bool load(const DiskCache& cache, int n) {
        std::vector<int> all;
        std::string text;
        const bool found = cache.read(key(n), [&](CacheReader& entry) {
            all = entry.get<int>();
            text = entry.get_text();
        });
        if (!found) return false;
        EXPECT_EQ(all, values(n));
        EXPECT_EQ(text, "text " + std::to_string(n));
        return true;
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const auto& file : fs::directory_iterator(folder_)) all.push_back(file.path());
        return all;
    }

    fs::path folder_;
};

TEST_F(DiskCacheTest, ReturnsWhatWasStoredUnderTheSameKeyOnly) {
    const DiskCache cache(folder_);
    EXPECT_FALSE(load(cache, 1));
    ASSERT_TRUE(store(cache, 1));
    ASSERT_TRUE(store(cache, 2));
    EXPECT_TRUE(load(cache, 1));
    EXPECT_TRUE(load(cache, 2));
    EXPECT_FALSE(load(cache, 3));
    EXPECT_TRUE(load(DiskCache(folder_), 1));
    EXPECT_FALSE(load(DiskCache(), 1));
    EXPECT_FALSE(store(DiskCache(), 1));
}

TEST_F(DiskCacheTest, NeighbouringArraysOfAKeyCannotTradeElements) {
    CacheKey a("k"), b("k");
    a.add_text("ab"), a.add_text("c");
    b.add_text("a"), b.add_text("bc");
    EXPECT_NE(a.low(), b.low());
    EXPECT_NE(a.high(), b.high());
    EXPECT_NE(a.low(), a.high());
}

// Every byte of an entry matters to its head, a size, a hash or what is hashed.
TEST_F(DiskCacheTest, AnEntryWithAnyByteChangedIsDeletedAndNotReturned) {
    const DiskCache cache(folder_);
    ASSERT_TRUE(store(cache, 7));
    const fs::path file = files().at(0);
    std::ifstream in(file, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t i = 0; i < good.size(); i += i < 64 ? 1 : 97) {
        std::string bad = good;
        bad[i] ^= 0x40;
        std::ofstream(file, std::ios::binary | std::ios::trunc) << bad;
        EXPECT_FALSE(load(cache, 7)) << i;
        EXPECT_FALSE(fs::exists(file)) << i;
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{10}, good.size() / 2, good.size() - 1}) {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << good.substr(0, size);
        EXPECT_FALSE(load(cache, 7)) << size;
    }
    std::ofstream(file, std::ios::binary | std::ios::trunc) << good;
    EXPECT_TRUE(load(cache, 7));
}

TEST_F(DiskCacheTest, AMappedArrayOutlivesItsEntryAndIsCheckedWhole) {
    const DiskCache cache(folder_);
    const auto all = std::make_shared<std::vector<int>>(300'000);  // two pieces, each with a hash
    std::iota(all->begin(), all->end(), 5);
    const auto put = [&] {
        return cache.write(key(1), [&](CacheWriter& entry) {
            entry.put_text("before");
            entry.put_to_map(SharedArray<int>(all, std::span<const int>(*all)));
            entry.put_to_map(SharedArray<int>());
            entry.put_text("after");
        });
    };
    const auto get = [&](SharedArray<int>& mapped) {
        return cache.read(key(1), [&](CacheReader& entry) {
            EXPECT_EQ(entry.get_text(), "before");
            std::size_t seen = 0;
            mapped = entry.map<int>([&](std::span<const int> some, std::size_t first) {
                EXPECT_EQ(first, seen);
                seen += some.size();
                return some.back() > 0;
            });
            EXPECT_EQ(seen, mapped.size());
            EXPECT_TRUE(entry.map<int>([](auto, auto) { return true; }).empty());
            EXPECT_EQ(entry.get_text(), "after");
        });
    };
    SharedArray<int> mapped;
    ASSERT_TRUE(put());
    ASSERT_TRUE(get(mapped));
    const fs::path file = files().at(0);
    const std::uintmax_t size = fs::file_size(file);
    fs::remove(file);
    EXPECT_TRUE(std::ranges::equal(mapped, *all));
    for (const std::uintmax_t at : {size / 3, size - 100'000}) {
        ASSERT_TRUE(put());
        std::fstream(file, std::ios::binary | std::ios::in | std::ios::out)
            .seekp(static_cast<std::streamoff>(at))
            .put(1);
        EXPECT_FALSE(get(mapped)) << at;
        EXPECT_FALSE(fs::exists(file)) << at;
    }
    ASSERT_TRUE(put());
    fs::resize_file(file, size / 2);
    EXPECT_FALSE(get(mapped));
}

TEST_F(DiskCacheTest, TheEntriesUsedLongestAgoAreDeletedFirst) {
    const DiskCache cache(folder_, 3 * 4200);  // an entry has about 4,100 bytes
    for (int n = 1; n <= 3; ++n) ASSERT_TRUE(store(cache, n));
    const auto now = fs::file_time_type::clock::now();
    for (const fs::path& file : files()) fs::last_write_time(file, now - std::chrono::hours(1));
    EXPECT_TRUE(load(cache, 1));  // used now
    ASSERT_TRUE(store(cache, 4));
    ASSERT_TRUE(store(cache, 5));
    cache.trim();
    EXPECT_EQ(files().size(), 3u);
    for (const int n : {1, 4, 5}) EXPECT_TRUE(load(cache, n)) << n;
}

TEST_F(DiskCacheTest, AFolderThatCannotBeMadeCostsNothingButTime) {
    std::ofstream(folder_.string()) << "a file";
    const DiskCache cache(folder_ / "below");
    EXPECT_FALSE(store(cache, 1));
    EXPECT_FALSE(load(cache, 1));
    cache.trim();
}

// Eight processes write, read and trim the same keys at once: an entry is whole or absent at any time.
TEST_F(DiskCacheTest, SeveralProcessesMayUseOneFolder) {
    std::vector<pid_t> children;
    for (int c = 0; c < 8; ++c) {
        const pid_t child = ::fork();
        if (child == 0) {
            const DiskCache cache(folder_, 4 * 4200);
            for (int round = 0; round < 50; ++round)
                for (int n = 0; n < 6; ++n) {
                    if (!load(cache, n)) store(cache, n);
                    if (n == c % 6) cache.trim();
                }
            ::_exit(testing::Test::HasFailure() ? 1 : 0);
        }
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = -1;
        ::waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    for (const fs::path& file : files()) EXPECT_FALSE(file.filename().string().starts_with('.')) << file;
}

}  // namespace
}  // namespace tuft
