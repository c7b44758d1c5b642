#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "stroke/document/document.h"

namespace tuft::app {

/// An entry of the journal that was changed, or taken out.
struct EntryChange {
    std::size_t at = 0;  ///< its place in the journal before
    stroke::JournalEntry before;
    std::optional<stroke::JournalEntry> after;  ///< none: taken out
    bool in_rows = false;                       ///< the file's rows can follow it; else it is written anew
};

/// The whole journal, before and after.
struct JournalChange {
    std::vector<stroke::JournalEntry> before, after;
};

/// What one undo takes back.
struct EditStep {
    std::size_t made = 0;                  ///< entries at the journal's end
    std::vector<EntryChange> changes;      ///< or these, in the journal's order
    std::optional<JournalChange> journal;  ///< or this
    bool joined = false;                   ///< and the step before it
};

/// What undo and redo go through, the last step at the back.
struct EditHistory {
    std::vector<EditStep> done, undone;

    /// A step was made: nothing can be redone any more.
    void add(EditStep step) {
        done.push_back(std::move(step));
        undone.clear();
    }
    /// A journal of so many entries, each one a step.
    void reset(std::size_t entries) {
        done.assign(entries, EditStep{.made = 1});
        undone.clear();
    }
};

}  // namespace tuft::app
