#pragma once

#include <cstddef>
#include <functional>

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

}  // namespace tuft
