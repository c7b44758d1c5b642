#pragma once

#include <cstddef>
#include <functional>

/// Parallel loops. Results never depend on the number of threads: a body writes
/// only to its own index, and sums are made from per-index parts in index order.
namespace tuft {

/// Threads that `parallel_for` may use from now on; 0 means one per core.
void set_thread_count(int n);
int thread_count();

/// Calls body(begin, end) over disjoint ranges that cover [0, n), none shorter
/// than `grain` but the last. Exceptions thrown by the body reach the caller; `Cancelled` is thrown
/// when the process was asked to stop (interrupt.h).
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace tuft
