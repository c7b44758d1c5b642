#include "core/system/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <queue>
#include <utility>

#include "core/system/interrupt.h"
#include "core/system/task_arena.h"

namespace tuft {
namespace {

std::atomic<int> g_threads{0};
thread_local bool t_in_task = false;

}  // namespace

tbb::task_arena& task_arena() {
    // One arena, rebuilt when the count changes; TBB sizes it once.
    static std::mutex mutex;
    static std::unique_ptr<tbb::task_arena> current;
    static int current_threads = -1;
    const std::lock_guard lock(mutex);
    const int threads = thread_count();
    if (threads != current_threads) {
        static std::unique_ptr<tbb::global_control> limit;
        limit = std::make_unique<tbb::global_control>(
            tbb::global_control::max_allowed_parallelism,
            static_cast<std::size_t>(std::max(threads, tbb::info::default_concurrency())));
        current = std::make_unique<tbb::task_arena>(threads);
        current_threads = threads;
    }
    return *current;
}

LoopsOnThisThread::LoopsOnThisThread() : before_(std::exchange(t_in_task, true)) {}

LoopsOnThisThread::~LoopsOnThisThread() {
    t_in_task = before_;
}

void set_thread_count(int n) {
    g_threads = std::max(0, n);
}

int thread_count() {
    const int n = g_threads;
    return n > 0 ? n : tbb::info::default_concurrency();
}

void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    check_interrupt();
    if (n == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    if (thread_count() == 1 || n <= grain || t_in_task) {
        body(0, n);
        return;
    }
    task_arena().execute([&] {
        // A thread that waits for a loop within a loop takes nothing of the outer one meanwhile, which may wait for it.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                              [&](const tbb::blocked_range<std::size_t>& r) {
                                  check_interrupt();
                                  body(r.begin(), r.end());
                              });
        });
    });
}

void run_tasks(const std::vector<std::vector<std::uint32_t>>& before, const std::function<void(std::size_t)>& task) {
    const std::size_t n = before.size();
    if (thread_count() == 1 || n <= 1) {
        for (std::size_t i = 0; i < n; ++i) task(i);
        return;
    }
    std::vector<std::vector<std::uint32_t>> after(n);
    std::vector<std::size_t> waits(n);
    std::mutex mutex;  // of `waits` and `ready`
    std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> ready;
    for (std::size_t i = 0; i < n; ++i) {
        waits[i] = before[i].size();
        if (before[i].empty()) ready.push(i);
        for (const std::uint32_t k : before[i]) after[k].push_back(static_cast<std::uint32_t>(i));
    }
    const auto take = [&] {
        const std::lock_guard lock(mutex);
        const std::size_t first = ready.top();
        ready.pop();
        return first;
    };
    const auto release = [&](std::size_t done) {
        const std::lock_guard lock(mutex);
        std::size_t released = 0;
        for (const std::uint32_t next : after[done])
            if (--waits[next] == 0) ready.push(next), ++released;
        return released;
    };
    task_arena().execute([&] {
        tbb::task_group group;
        // One call for every task that is ready; which one it takes is decided when it runs.
        const std::function<void()> run_next = [&] {
            const std::size_t i = take();
            {
                const LoopsOnThisThread sequential;
                task(i);
            }
            for (std::size_t k = release(i); k > 0; --k) group.run(run_next);
        };
        for (std::size_t k = ready.size(); k > 0; --k) group.run(run_next);
        group.wait();
    });
}

}  // namespace tuft
