#pragma once

#include <cstddef>
#include <functional>
#include <memory>

/// \file
/// A sequence of steps that a thread performs before another one needs their results. `stroke` bends the hair of a
/// stroke ahead of its ink by it.
namespace tuft {

/// Steps 0, 1, … n − 1, each of which may use what those before it left. Calls of `step` come in order and one at a
/// time, not always from the same thread. Loops within a step run on its thread. Results do not depend on the number of
/// threads.
class WorkAhead {
  public:
    /// At most `window` steps are performed ahead of the last one that was waited for.
    WorkAhead(std::size_t n, std::size_t window, std::function<void(std::size_t)> step);
    /// Waits for the step that is being performed; those after it are not performed.
    ~WorkAhead();
    WorkAhead(const WorkAhead&) = delete;
    WorkAhead& operator=(const WorkAhead&) = delete;

    /// Lets another thread begin. Without it none does before the first wait.
    void begin();
    /// Returns once step `i` < n has been performed. The caller performs what no other thread has begun. Throws what a
    /// step threw; no step is performed after that. One caller at a time.
    void wait(std::size_t i);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft
