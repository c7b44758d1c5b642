#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "stroke/document/document.h"

/// \file
/// Undo and redo. Paint thread.
namespace tuft::app {

/// A changed or removed entry of the journal.
struct EntryChange {
    std::size_t at = 0;  ///< its former index in the journal
    stroke::JournalEntry before;
    std::optional<stroke::JournalEntry> after;  ///< none: removed
    bool in_rows = false;                       ///< single rows of the file can express it; else it is written anew
};

/// The whole journal, before and after.
struct JournalChange {
    std::vector<stroke::JournalEntry> before, after;
};

/// One undo step; exactly one of the first three members is set.
struct EditStep {
    std::size_t made = 0;              ///< number of entries appended
    std::vector<EntryChange> changes;  ///< in the journal's order
    std::optional<JournalChange> journal;
    bool joined = false;  ///< the step before is undone with it
};

/// Steps to undo and to redo, the next one last.
struct EditHistory {
    std::vector<EditStep> done, undone;

    /// Adds a step and clears the redo list.
    void add(EditStep step) {
        done.push_back(std::move(step));
        undone.clear();
    }
    /// Starts with a journal of `entries` entries, each one a step.
    void reset(std::size_t entries) {
        done.assign(entries, EditStep{.made = 1});
        undone.clear();
    }
};

}  // namespace tuft::app
