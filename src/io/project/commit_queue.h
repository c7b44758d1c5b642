#pragma once

#include <memory>

#include "io/project/project.h"

/// \file
/// Commits finished strokes to a project while the next ones are painted. Called by `tuft paint`.
namespace tuft::io {

/// Strokes on their way into a project. A thread of its own commits all that have been added since its last
/// transaction in the next one: a commit waits for the disk four times, whatever its size. The project must outlive the
/// queue, is not used otherwise until `finish` returns, and reports no progress until `listen` is called again.
class CommitQueue {
  public:
    explicit CommitQueue(Project& project);
    /// Commits what was added; an error is lost.
    ~CommitQueue();
    CommitQueue(const CommitQueue&) = delete;
    CommitQueue& operator=(const CommitQueue&) = delete;

    /// Adds a finished stroke; its id must be new. Throws the `Error` of an earlier commit; that stroke and those after
    /// it are not in the project then.
    void add(const stroke::JournalEntry& stroke);
    /// Returns once all is committed. Throws as `add` does.
    void finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::io
