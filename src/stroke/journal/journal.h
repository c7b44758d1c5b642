#pragma once

#include <cstdint>
#include <vector>

#include "stroke/journal/entry/entry.h"

/// \file
/// The journal: entries in order, with undo and redo. `Document` owns one and makes texels from it.

namespace tuft::stroke {

/// Entries in the order in which they are performed.
class Journal {
  public:
    /// Appends an entry with the next free id. Entries taken back are forgotten.
    const JournalEntry& append(JournalEntry entry);
    /// Appends a stored entry with its own id.
    void restore(JournalEntry entry);
    /// Take the last entry off, and put the last one taken off back. False when there is none.
    bool undo();
    bool redo();
    /// Sets the entries for `redo`, the next one last, of a journal that this one replaces.
    void restore_undone(std::vector<JournalEntry> undone) { undone_ = std::move(undone); }
    const std::vector<JournalEntry>& undone() const { return undone_; }
    bool can_undo() const { return !entries_.empty(); }
    bool can_redo() const { return !undone_.empty(); }

    /// Returns the id that the next appended entry gets.
    std::uint64_t next_id() const { return next_id_; }
    /// Returns an id that no group of this journal has.
    std::uint64_t next_group_id() const;

    const std::vector<JournalEntry>& entries() const { return entries_; }
    bool empty() const { return entries_.empty(); }

  private:
    std::vector<JournalEntry> entries_;
    std::vector<JournalEntry> undone_;  ///< last undone at the back
    std::uint64_t next_id_ = 1;
};

}  // namespace tuft::stroke
