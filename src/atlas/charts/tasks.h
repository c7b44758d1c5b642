#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/parallel.h"

namespace tuft::atlas {

/// Calls task(i) for i in [0, n), each thread taking the next one when it is free: for tasks
/// of very different size, the largest first. Exceptions reach the caller.
template <class Task>
void run_tasks(std::size_t n, Task&& task) {
    std::atomic<std::size_t> next{0};
    const std::size_t threads = std::min(n, static_cast<std::size_t>(thread_count()));
    parallel_for(threads, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t worker = begin; worker < end; ++worker)
            for (std::size_t i = next++; i < n; i = next++) task(i);
    });
}

}  // namespace tuft::atlas
