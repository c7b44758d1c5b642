#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

/// \file
/// Parallel loops for all modules. Results never depend on the number of threads: a body writes only to its own
/// index, and sums are made from per-index parts in index order.
namespace tuft {

/// Sets the number of threads of `parallel_for`; 0 means one per core.
void set_thread_count(int n);
int thread_count();

/// Calls body(begin, end) over disjoint ranges that cover [0, n). Every range but the last has at least `grain`
/// elements. Exceptions of the body reach the caller. Throws `Cancelled` when the process is interrupted
/// (interrupt.h).
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls task(i) once for each i in [0, before.size()), for up to `thread_count` of them at a time. Task i starts after
/// the tasks `before[i]`, all of them below i, have returned; of those that can start, the lowest goes first. On one
/// thread tasks run in order. `task` must not throw. Loops within a task run on its thread. Unlike `parallel_for` it
/// does not end early when the process is interrupted: tasks look at the flag themselves.
void run_tasks(const std::vector<std::vector<std::uint32_t>>& before, const std::function<void(std::size_t i)>& task);

}  // namespace tuft
