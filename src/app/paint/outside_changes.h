#pragma once

#include <span>

#include "app/work/paint_context.h"
#include "io/project/project.h"
#include "stroke/document/merge.h"

namespace tuft::app {

/// Takes in what other programs do to the project meanwhile.
class OutsideChanges {
  public:
    explicit OutsideChanges(PaintContext& context) : context_(context) {}

    /// Looks whether the file changed; while a stroke is in hand it waits. Costs microseconds when it did not.
    void look();

  private:
    void take();
    void paint_merged(const io::Project& file, const stroke::MergedJournal& merged);
    bool follow(const io::Project& file, std::span<const stroke::JournalEntry> theirs);
    void leave_file();

    PaintContext& context_;
};

}  // namespace tuft::app
