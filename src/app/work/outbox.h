#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "app/work/update.h"
#include "core/message.h"
#include "core/system/progress.h"

/// \file
/// Updates from the paint thread to the window.
namespace tuft::app {

/// Collects changes for the window. Thread-safe: the paint thread fills it, the window thread takes.
class Outbox {
  public:
    /// Calls `how(Update&)` on the pending update.
    template <class Fn>
    void change(const Fn& how) {
        const std::lock_guard lock(mutex_);
        how(update_);
    }
    /// Adds a message for the status bar.
    void report(Message message);
    /// Shows the progress of long work, 0–1.
    void show_progress(const std::string& name, double fraction);
    /// Returns the events since the last call and the present status.
    Update take();

  private:
    std::mutex mutex_;
    Update update_;
};

}  // namespace tuft::app
