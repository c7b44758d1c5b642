#include "core/system/work_ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "core/system/parallel.h"

namespace tuft {
namespace {

class WorkAheadTest : public testing::Test {
  protected:
    void TearDown() override { set_thread_count(0); }
};

TEST_F(WorkAheadTest, StepsComeInOrderOneAtATimeAndNotTooFarAhead) {
    constexpr std::size_t n = 200, window = 4;
    for (const int threads : {1, 2, 4}) {
        set_thread_count(threads);
        std::atomic<std::size_t> next{0}, waited{0};
        std::atomic<int> at_work{0}, faults{0};
        std::vector<std::size_t> results(n, 0);
        WorkAhead work(n, window, [&](std::size_t i) {
            faults += ++at_work != 1;
            faults += i != next++;
            faults += i > waited + window;
            // Loops within a step run on its thread.
            std::size_t sum = 0;
            parallel_for(100, 1, [&](std::size_t begin, std::size_t end) { sum += end - begin; });
            results[i] = sum + (i > 0 ? results[i - 1] : 0);
            --at_work;
        });
        for (std::size_t i = 0; i < n; ++i) {
            waited = i;
            work.wait(i);
            EXPECT_EQ(results[i], 100 * (i + 1));
            // The caller's loops find threads meanwhile.
            std::atomic<std::size_t> sum{0};
            parallel_for(8, 1, [&](std::size_t begin, std::size_t end) { sum += end - begin; });
            EXPECT_EQ(sum, 8u);
        }
        EXPECT_EQ(faults, 0);
        EXPECT_EQ(next, n);
    }
}

TEST_F(WorkAheadTest, WhatIsNotWaitedForIsLeft) {
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        std::atomic<std::size_t> done{0};
        {
            WorkAhead work(100, 2, [&](std::size_t) { ++done; });
            work.begin();
            work.wait(10);
        }
        EXPECT_GE(done, 11u);
        EXPECT_LE(done, 13u);
        WorkAhead never(3, 1, [](std::size_t) { FAIL(); });
    }
}

TEST_F(WorkAheadTest, AFaultComesToWhoeverNeedsTheStep) {
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        std::atomic<std::size_t> done{0};
        WorkAhead work(10, 9, [&](std::size_t i) {
            if (i == 5) throw std::runtime_error("five");
            ++done;
        });
        EXPECT_NO_THROW(work.wait(0));
        EXPECT_THROW(work.wait(7), std::runtime_error);
        EXPECT_THROW(work.wait(9), std::runtime_error);
        EXPECT_EQ(done, 5u) << "no step after it";
    }
}

}  // namespace
}  // namespace tuft
