#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/parallel.h"

namespace tuft::atlas {

/// Calls task(i, worker) for i in [0, n), each thread taking the next one when it is free: for tasks
/// of very different size, the largest first. Workers are numbered from 0 to `thread_count()` - 1,
/// each does one task at a time. Exceptions reach the caller.
template <class Task>
void run_tasks_by_worker(std::size_t n, Task&& task) {
    std::atomic<std::size_t> next{0};
    const std::size_t threads = std::min(n, static_cast<std::size_t>(thread_count()));
    parallel_for(threads, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t worker = begin; worker < end; ++worker)
            for (std::size_t i = next++; i < n; i = next++) task(i, worker);
    });
}

/// The same where it does not matter who does it: task(i).
template <class Task>
void run_tasks(std::size_t n, Task&& task) {
    run_tasks_by_worker(n, [&](std::size_t i, std::size_t) { task(i); });
}

}  // namespace tuft::atlas
