#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stroke/journal/journal.h"

/// \file
/// Three-way merge of journals. Called by the studio when another program changed the open project.
namespace tuft::stroke {

/// Identity and content of an entry at some time, to detect changes.
struct EntryMark {
    std::uint64_t id = 0;
    std::uint64_t content = 0;  ///< hash of all that a project stores of it but its id; complemented for a hidden entry
    bool hidden = false;

    bool operator==(const EntryMark&) const = default;
};
/// Return the marks of entries. `set_hidden` changes a mark as hiding its entry does.
EntryMark mark_of(const JournalEntry& entry);
void set_hidden(EntryMark& mark, bool hidden);
std::vector<EntryMark> marks_of(std::span<const JournalEntry> entries);

/// Result of `merge_journals`.
struct MergedJournal {
    std::vector<JournalEntry> entries;
    std::size_t from_theirs = 0;  ///< number of leading entries that are all of theirs, unchanged; 0 if `altered`
    bool altered = false;         ///< mine removed or changed some of theirs
    std::size_t news = 0;         ///< entries of theirs that are new to mine or differ from it
};

/// Merges `mine` and `theirs`, both descended from `base`. The result has the entries of `theirs` in their order, then
/// those that only `mine` has, in their order. Nothing painted or changed on either side is lost: an entry is removed
/// only where one side removed it and the other did not change it; of an entry changed on both sides that of `mine`
/// stays. Entries of `mine` get free ids; their layers and masks get free ids and names. A layer or mask that they need
/// and `theirs` removed is added again. Edits of layers that `theirs` made impossible are left out.
MergedJournal merge_journals(std::span<const EntryMark> base, std::vector<JournalEntry> mine,
                             std::vector<JournalEntry> theirs);

}  // namespace tuft::stroke
