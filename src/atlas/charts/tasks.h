#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

#include "core/system/parallel.h"

/// \file
/// Parallel execution of tasks of very different size. Used by all steps of atlas/charts.
namespace tuft::atlas {

/// Calls task(i, worker) for i in [0, n). A free thread takes the next task; put the largest first. Workers are
/// numbered from 0 to `thread_count()` − 1, and each runs one task at a time. Exceptions reach the caller.
template <class Task>
void run_tasks_by_worker(std::size_t n, Task&& task) {
    std::atomic<std::size_t> next{0};
    const std::size_t threads = std::min(n, static_cast<std::size_t>(thread_count()));
    parallel_for(threads, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t worker = begin; worker < end; ++worker)
            for (std::size_t i = next++; i < n; i = next++) task(i, worker);
    });
}

/// The same without the worker's number: task(i).
template <class Task>
void run_tasks(std::size_t n, Task&& task) {
    run_tasks_by_worker(n, [&](std::size_t i, std::size_t) { task(i); });
}

/// The same with a memory bound: concurrent tasks have a total weight of at most `most`, unless one task alone
/// exceeds it. Each thread takes the first task that fits, or waits. weight(i) is constant.
template <class Weight, class Task>
void run_tasks_within(std::size_t n, double most, Weight&& weight, Task&& task) {
    std::mutex mutex;
    std::condition_variable freed;
    std::vector<bool> started(n, false);
    std::size_t first = 0, running = 0;
    double weighs = 0;
    const auto work = [&] {
        std::unique_lock lock(mutex);
        for (;;) {
            while (first < n && started[first]) ++first;
            if (first == n) return;
            std::size_t i = first;
            while (i < n && (started[i] || (running > 0 && weighs + weight(i) > most))) ++i;
            if (i == n) {
                freed.wait(lock);
                continue;
            }
            started[i] = true;
            ++running;
            weighs += weight(i);
            struct Release {
                std::unique_lock<std::mutex>& lock;
                std::condition_variable& freed;
                std::size_t& running;
                double &weighs, weight;
                ~Release() {
                    lock.lock();
                    weighs = --running > 0 ? weighs - weight : 0;
                    freed.notify_all();
                }
            };
            const Release release{lock, freed, running, weighs, weight(i)};
            lock.unlock();
            task(i);
        }
    };
    const std::size_t threads = std::min(n, static_cast<std::size_t>(thread_count()));
    parallel_for(threads, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t worker = begin; worker < end; ++worker) work();
    });
}

/// Returns the number of triangles that are flattened concurrently: a quarter of the mesh, at least 300,000. Each
/// takes about 0.7 kB meanwhile.
inline double flattened_at_once(std::size_t n_triangles) {
    return std::max(3e5, 0.25 * static_cast<double>(n_triangles));
}

}  // namespace tuft::atlas
