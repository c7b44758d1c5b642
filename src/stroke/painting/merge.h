#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stroke/journal/journal.h"

/// Two journals that went on from the same one, made one again.
namespace tuft::stroke {

/// What is remembered of an entry, to tell later whether somebody changed it.
struct EntryMark {
    std::uint64_t id = 0;
    std::uint64_t content = 0;  ///< hash of all that a project stores of it, but for its id; of a
                                ///< hidden one with all bits turned
    bool hidden = false;

    bool operator==(const EntryMark&) const = default;
};
EntryMark mark_of(const Stroke& entry);
void set_hidden(EntryMark& mark, bool hidden);
std::vector<EntryMark> marks_of(std::span<const Stroke> entries);

struct MergedJournal {
    std::vector<Stroke> entries;
    std::size_t from_theirs = 0;  ///< the first so many are all of theirs, as they are; the rest is painted after them
    bool altered = false;         ///< else: mine took out or changed some of theirs, and `from_theirs` is 0
    std::size_t news = 0;         ///< entries of theirs that mine did not have, or not so
};

/// Three-way merge of `mine` and `theirs`, which both came from `base`. Theirs goes first, in its
/// order; what only mine has is painted after it, in its order. Nothing that was painted or changed
/// on either side is lost: an entry goes only where one side took it out and the other left it as
/// it was; of an entry that both changed mine stays. What comes after gets ids that are free,
/// layers and masks too, under names that are free; a layer or mask that it needs and theirs has no
/// more is added again. Of changes of layers, those that theirs makes impossible are left out.
MergedJournal merge_journals(std::span<const EntryMark> base, std::vector<Stroke> mine, std::vector<Stroke> theirs);

}  // namespace tuft::stroke
