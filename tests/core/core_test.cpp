#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <random>
#include <set>
#include <unordered_map>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/modified_time.h"
#include "core/geometry/plane_vectors.h"
#include "core/geometry/sparse_numbering.h"
#include "core/geometry/types.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "core/text/units.h"

namespace tuft {
namespace {

Vec3 random_unit(Random& random) {
    const double z = random.uniform(-1, 1), phi = random.uniform(0, 6.283185307179586);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(PlaneVectors, TurningByTheAngleBetweenLeadsFromOneToTheOther) {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Vec2 a(random.uniform(-1, 1), random.uniform(-1, 1)), b(random.uniform(-1, 1), random.uniform(-1, 1));
        // A dozen roundings of numbers of order one.
        const Vec2 there = turned(a, angle_between(a, b));
        EXPECT_NEAR(cross(there, b), 0, 1e-14);
        EXPECT_GE(glm::dot(there, b), 0);
        EXPECT_EQ(cross(a, b), -cross(b, a));
    }
}

TEST(ParallelTransport, TakesOneDirectionToTheOtherAndKeepsLengthsAndAngles) {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 from = random_unit(random), to = random_unit(random);
        const Vec3 v = random_unit(random), w = random_unit(random);
        // A rotation in double: a few rounding errors of 1e-16, amplified near opposite vectors.
        EXPECT_LT(glm::length(parallel_transport(from, from, to) - to), 1e-10);
        EXPECT_NEAR(glm::dot(parallel_transport(v, from, to), parallel_transport(w, from, to)), glm::dot(v, w), 1e-10);
    }
}

TEST(ParallelTransport, TurnsHalfWayForOppositeVectors) {
    const Vec3 z{0, 0, 1};
    EXPECT_LT(glm::length(parallel_transport(z, z, -z) + z), 1e-12);
}

TEST(Frame, IsRightHandedAndOrthonormalForAnyNormal) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Frame f = make_frame(Vec3{1, 2, 3}, random_unit(random), random_unit(random));
        EXPECT_NEAR(glm::dot(glm::cross(f.t, f.b), f.n), 1, 1e-12);
        const Vec3 p{0.3, -0.2, 0.7};
        EXPECT_LT(glm::length(f.to_world(f.to_local(p)) - p), 1e-12);
    }
    EXPECT_NEAR(glm::length(make_frame(Vec3{0}, Vec3{1, 0, 0}, Vec3{1, 0, 0}).t), 1, 1e-12);
}

TEST(ParallelFor, VisitsEveryIndexOnceForAnyThreadCount) {
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        std::vector<std::atomic<int>> hits(10007);
        parallel_for(hits.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++hits[i];
        });
        for (const auto& h : hits) ASSERT_EQ(h, 1);
    }
    set_thread_count(0);
}

TEST(ParallelFor, HandsExceptionsToTheCaller) {
    EXPECT_THROW(parallel_for(100, 1, [](std::size_t, std::size_t) { throw Error("x"); }), Error);
}

TEST(Random, IsUniformAndRepeatable) {
    Random a(7), b(7);
    double sum = 0;
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double x = a.uniform();
        ASSERT_EQ(x, b.uniform());
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        sum += x;
    }
    // The mean of n uniforms has standard deviation 1/sqrt(12 n); five of them.
    EXPECT_NEAR(sum / n, 0.5, 5 / std::sqrt(12.0 * n));
}

TEST(NearestName, SuggestsTheLikelyOneAndStaysSilentOtherwise) {
    const std::vector<std::string> names{"wolf-medium", "goat-medium", "mixed-large"};
    EXPECT_EQ(nearest_name("wolff-medium", names), "wolf-medium");
    EXPECT_EQ(nearest_name("goat-mediun", names), "goat-medium");
    EXPECT_EQ(nearest_name("qqqq", names), "");
}

TEST(Units, ConvertsTheNamesPeopleUse) {
    EXPECT_DOUBLE_EQ(*metres_per("mm"), 1e-3);
    EXPECT_DOUBLE_EQ(*metres_per("in"), 0.0254);
    EXPECT_FALSE(metres_per("furlong"));
}

class Files : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) / ("tuft_files_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

TEST_F(Files, WrittenBytesAreReadBack) {
    const std::string text = "ink";
    write_file(folder_ / "a.bin", text.data(), text.size());
    const std::vector<char> back = read_file(folder_ / "a.bin");
    EXPECT_EQ(std::string(back.begin(), back.end()), text);
}

TEST_F(Files, FailedWriteLeavesTheOldFileAndNothingBeside) {
    write_file(folder_ / "a.bin", "old", 3);
    EXPECT_THROW(write_atomically(folder_ / "a.bin",
                                  [](const std::filesystem::path& temporary) {
                                      std::ofstream(temporary) << "half";
                                      throw Error("stopped");
                                  }),
                 Error);
    EXPECT_EQ(read_file(folder_ / "a.bin").size(), 3u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(Files, MissingEmptyAndFolderAreErrors) {
    EXPECT_THROW(read_file(folder_ / "missing"), Error);
    EXPECT_FALSE(modified_time(folder_ / "missing"));
    EXPECT_THROW(read_file(folder_), Error);
    std::ofstream(folder_ / "empty");
    EXPECT_THROW(read_file(folder_ / "empty"), Error);
    EXPECT_THROW(write_file(folder_ / "no" / "such" / "x", "x", 1), Error);
}

TEST(ShippedFiles, AnEmptyVariableNamesNoFolder) {
    const char* set = std::getenv("TUFT_DATA");
    const std::string kept = set ? set : "";
    ::unsetenv("TUFT_DATA");
    const std::filesystem::path unnamed = data_folder();
    ::setenv("TUFT_DATA", "", 1);
    EXPECT_EQ(data_folder(), unnamed);
    ::setenv("TUFT_DATA", "/elsewhere", 1);
    EXPECT_EQ(data_folder(), "/elsewhere");
    if (set)
        ::setenv("TUFT_DATA", kept.c_str(), 1);
    else
        ::unsetenv("TUFT_DATA");
}

}  // namespace
// Against the standard library's map, through growth, clearing and keys that are all ones.
TEST(SparseNumbering, NumbersKeysInTheOrderInWhichTheyCome) {
    SparseNumbering numbering;
    std::mt19937 random(7);
    for (int round = 0; round < 5; ++round) {
        numbering.clear();
        std::unordered_map<std::uint32_t, std::uint32_t> expected;
        for (int i = 0; i < 5000; ++i) {
            const std::uint32_t key = i % 97 == 0 ? kNone - random() % 3 : random() % 4000;
            const auto [at, is_new] = expected.try_emplace(key, static_cast<std::uint32_t>(expected.size()));
            EXPECT_EQ(numbering.number(key), std::pair(at->second, is_new));
        }
        EXPECT_EQ(numbering.size(), expected.size());
        for (std::uint32_t key = 0; key < 4000; ++key) {
            const auto at = expected.find(key);
            EXPECT_EQ(numbering.find(key), at == expected.end() ? kNone : at->second);
        }
    }
}

}  // namespace tuft
