#pragma once

#include <tbb/task_arena.h>

/// \file
/// The threads that loops, tasks and work ahead share. Called by parallel.cpp and work_ahead.cpp only.
namespace tuft {

/// Returns the arena of `thread_count` threads.
tbb::task_arena& task_arena();

/// While it exists, loops of this thread run on this thread.
class LoopsOnThisThread {
  public:
    LoopsOnThisThread();
    ~LoopsOnThisThread();
    LoopsOnThisThread(const LoopsOnThisThread&) = delete;
    LoopsOnThisThread& operator=(const LoopsOnThisThread&) = delete;

  private:
    bool before_;
};

}  // namespace tuft
