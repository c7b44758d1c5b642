#include "core/system/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <vector>

namespace tuft {
namespace {

TEST(RunTasks, EveryTaskRunsOnceAfterThoseBefore) {
    std::mt19937 random(7);
    constexpr std::size_t n = 400;
    std::vector<std::vector<std::uint32_t>> before(n);
    for (std::uint32_t i = 1; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            if (random() % 2) before[i].push_back(static_cast<std::uint32_t>(random() % i));
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        std::vector<std::atomic<int>> runs(n);
        std::atomic<int> early{0};
        run_tasks(before, [&](std::size_t i) {
            for (const std::uint32_t k : before[i]) early += runs[k] != 1;
            // Loops within a task take no other task meanwhile.
            std::atomic<std::size_t> sum{0};
            parallel_for(64, 1, [&](std::size_t begin, std::size_t end) { sum += end - begin; });
            early += sum != 64;
            ++runs[i];
        });
        EXPECT_EQ(early, 0);
        for (const std::atomic<int>& r : runs) EXPECT_EQ(r, 1);
    }
    set_thread_count(0);
}

TEST(RunTasks, OneThreadTakesThemInOrder) {
    set_thread_count(1);
    std::vector<std::size_t> order;
    run_tasks(std::vector<std::vector<std::uint32_t>>(20), [&](std::size_t i) { order.push_back(i); });
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
    EXPECT_EQ(order.size(), 20u);
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft
