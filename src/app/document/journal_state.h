#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "app/document/paint_thread.h"
#include "mesh/query/surface_query.h"

namespace tuft::app {

/// What is chosen in the journal, and how its list is shown.
struct JournalState {
    std::set<std::uint64_t> selected;            ///< ids of entries
    std::uint64_t anchor = 0;                    ///< entry clicked last, from which Shift selects a range
    bool anchor_inside = false;                  ///< it was clicked under its group, not the group's own row
    std::set<std::uint64_t> open_groups;         ///< whose entries are listed
    std::vector<OutlinePoint> outline;           ///< rim of the ink that the chosen entries leave
    bool moves = false;                          ///< the next drag over the model moves them
    std::optional<mesh::SurfacePoint> from, to;  ///< of that drag

    bool holds(std::uint64_t id) const { return selected.contains(id); }
};

/// A row of the list: an entry, or a group with its entries.
struct JournalRow {
    std::uint64_t group = 0;         ///< of a group's own row; 0: an entry
    std::vector<std::size_t> lines;  ///< indices of its entries, in the journal's order
    bool inside = false;             ///< an entry listed under its group
};

/// Rows from the newest entry to the oldest. A group of at least two entries has a row of its own where its newest
/// entry is; its entries follow where it is open.
std::vector<JournalRow> journal_rows(const std::vector<StrokeLine>& lines, const std::set<std::uint64_t>& open_groups);

}  // namespace tuft::app
