#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "app/work/commands.h"

/// \file
/// Queue of commands from the window to the paint thread.
namespace tuft::app {

/// A thread-safe queue. The window posts, the paint thread waits.
class CommandQueue {
  public:
    /// Appends a command. Any thread.
    void post(Command command);
    /// Ends posting. Waiting commands are still returned.
    void close();

    /// True when no command waits or runs.
    bool idle() const;
    /// Waits until `idle`, at most that many seconds.
    void wait_idle(double seconds) const;
    /// Number of commands not finished yet, the running one included.
    std::size_t waiting() const;
    /// True when a command waits.
    bool pending() const;
    /// True when a command waits or the queue is closed: interruptible work should end.
    bool interrupts() const;

    /// Marks the previous command as finished and returns the next one. Paint thread. `nothing`: none came within
    /// `patience`. `closed`: none will come.
    enum class Next { command, nothing, closed };
    Next wait(Command& command, std::chrono::milliseconds patience);
    /// Takes the `ExtendStroke`s that wait next, as far as their poses last no longer than `seconds` with those of
    /// `command`, and appends them to it. Returns whether another one waits next. Paint thread.
    bool join(ExtendStroke& command, double seconds);

  private:
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    mutable std::condition_variable rests_;
    std::deque<Command> queue_;
    bool working_ = false, closed_ = false;
};

}  // namespace tuft::app
