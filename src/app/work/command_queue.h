#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "app/work/commands.h"

namespace tuft::app {

/// Commands on their way from the window to the paint thread.
class CommandQueue {
  public:
    void post(Command command);
    /// No command comes any more; those that wait are still handed out.
    void close();

    /// Nothing waits and nothing is being done.
    bool idle() const;
    /// Waits until it is so, but not longer than so many seconds.
    void wait_idle(double seconds) const;
    /// Commands not done yet, with the one in work.
    std::size_t waiting() const;
    /// Some command waits.
    bool pending() const;
    /// Some command waits, or none comes any more: what can be interrupted ends.
    bool interrupts() const;

    /// The paint thread's side: the command before is done, the next one is due. `nothing` when none came within
    /// `patience`, `closed` when none will come.
    enum class Next { command, nothing, closed };
    Next wait(Command& command, std::chrono::milliseconds patience);

  private:
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    mutable std::condition_variable rests_;
    std::deque<Command> queue_;
    bool working_ = false, closed_ = false;
};

}  // namespace tuft::app
