#pragma once

#include <span>

#include "app/work/paint_context.h"
#include "io/project/project.h"
#include "stroke/journal/merge.h"

/// \file
/// Changes of the project by other programs. Paint thread.
namespace tuft::app {

/// Merges changes of other programs into the work.
class OutsideChanges {
  public:
    explicit OutsideChanges(PaintContext& context) : context_(context) {}

    /// Merges the file's changes, if any. Does nothing during a stroke. Cost without changes: some microseconds.
    void poll();

  private:
    void take();
    void paint_merged(const io::Project& file, const stroke::MergedJournal& merged);
    bool follow(const io::Project& file, std::span<const stroke::JournalEntry> theirs);
    void leave_file();

    PaintContext& context_;
};

}  // namespace tuft::app
