#pragma once

#include <cstdint>
#include <vector>

#include "stroke/journal/entry.h"

namespace tuft::stroke {

/// What the hand did, in order, with undo and redo. Texels are made from it.
class Journal {
  public:
    /// Appends an entry (its id is set here); what could be redone is gone.
    const JournalEntry& append(JournalEntry entry);
    /// Puts an entry back as it was stored, id kept.
    void restore(JournalEntry entry);
    /// Takes the last entry off, to be put back by `redo`; false when there is none.
    bool undo();
    bool redo();
    /// Entries that `redo` shall bring back, the next one last; of a journal that this one takes the place of.
    void restore_undone(std::vector<JournalEntry> undone) { undone_ = std::move(undone); }
    const std::vector<JournalEntry>& undone() const { return undone_; }
    bool can_undo() const { return !entries_.empty(); }
    bool can_redo() const { return !undone_.empty(); }

    /// The id that the next appended entry gets.
    std::uint64_t next_id() const { return next_id_; }
    /// An id that no group of this journal has.
    std::uint64_t next_group_id() const;

    const std::vector<JournalEntry>& entries() const { return entries_; }
    bool empty() const { return entries_.empty(); }

  private:
    std::vector<JournalEntry> entries_;
    std::vector<JournalEntry> undone_;  ///< last undone at the back
    std::uint64_t next_id_ = 1;
};

}  // namespace tuft::stroke
