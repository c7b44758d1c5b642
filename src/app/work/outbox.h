#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "app/work/update.h"
#include "core/message.h"
#include "core/system/progress.h"

namespace tuft::app {

/// What the paint thread has for the window: one thread fills it, the other empties it.
class Outbox {
  public:
    /// Changes what the window will get: `how(Update&)`.
    template <class Fn>
    void change(const Fn& how) {
        const std::lock_guard lock(mutex_);
        how(update_);
    }
    /// A line for the status bar.
    void report(Message message);
    /// Shows how far long work is, under its name.
    void show_progress(const std::string& name, double fraction);
    /// Events since the last call, and the status as it is.
    Update take();

  private:
    std::mutex mutex_;
    Update update_;
};

}  // namespace tuft::app
