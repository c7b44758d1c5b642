#include "stroke/journal/journal.h"

#include <algorithm>
#include <set>
#include <utility>

namespace tuft::stroke {

std::uint64_t Journal::next_group_id() const {
    std::set<std::uint64_t> used;
    for (const std::vector<JournalEntry>* entries : {&entries_, &undone_})
        for (const JournalEntry& e : *entries) used.insert(e.group.id);
    std::uint64_t id = next_id_;
    while (used.contains(id)) ++id;
    return id;
}

const JournalEntry& Journal::append(JournalEntry entry) {
    entry.id = next_id_++;
    undone_.clear();
    entries_.push_back(std::move(entry));
    return entries_.back();
}

void Journal::restore(JournalEntry entry) {
    next_id_ = std::max(next_id_, entry.id + 1);
    entries_.push_back(std::move(entry));
}

bool Journal::undo() {
    if (entries_.empty()) return false;
    undone_.push_back(std::move(entries_.back()));
    entries_.pop_back();
    return true;
}

bool Journal::redo() {
    if (undone_.empty()) return false;
    entries_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return true;
}

}  // namespace tuft::stroke
