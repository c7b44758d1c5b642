#include "atlas/charts/tasks.h"

#include <gtest/gtest.h>

#include <mutex>
#include <stdexcept>

namespace tuft::atlas {
namespace {

struct Threads {
    explicit Threads(int n) { set_thread_count(n); }
    ~Threads() { set_thread_count(0); }
};

TEST(Tasks, ThatRunAtOnceKeepWithinTheirWeight) {
    for (const int threads : {1, 2, 4}) {
        const Threads use(threads);
        std::vector<double> weights;
        for (int i = 0; i < 200; ++i) weights.push_back(i % 7 == 0 ? 12 : i % 5);  // some heavier than all may be
        constexpr double kMost = 10;
        std::mutex mutex;
        double now = 0, greatest = 0;
        int running = 0;
        std::vector<int> done(weights.size(), 0);
        run_tasks_within(
            weights.size(), kMost, [&](std::size_t i) { return weights[i]; },
            [&](std::size_t i) {
                {
                    const std::lock_guard lock(mutex);
                    now += weights[i];
                    if (++running > 1) greatest = std::max(greatest, now);
                }
                // A loop within, which other threads may help with.
                std::vector<double> parts(64, 0);
                parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t k = begin; k < end; ++k)
                        for (int j = 0; j < 2000; ++j) parts[k] += 1e-3 * j;
                });
                const std::lock_guard lock(mutex);
                now -= weights[i];
                --running;
                done[i] += parts[63] > 0;
            });
        EXPECT_LE(greatest, kMost) << threads;
        for (const int d : done) EXPECT_EQ(d, 1);
    }
}

TEST(Tasks, ThatThrowReachTheCaller) {
    const Threads use(2);
    EXPECT_THROW(run_tasks_within(
                     50, 1, [](std::size_t) { return 1.0; },
                     [](std::size_t i) {
                         if (i == 20) throw std::runtime_error("stop");
                     }),
                 std::runtime_error);
}

}  // namespace
}  // namespace tuft::atlas
