#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "app/paint/paint_thread.h"
#include "app/view/view_state.h"
#include "mesh/query/surface_query.h"

/// \file
/// The journal in the window. Window thread.
namespace tuft::app {

/// Entries of the journal, the selection and the state of the list.
struct JournalState {
    std::vector<StrokeLine> lines;               ///< all entries, oldest first
    std::set<std::uint64_t> selected;            ///< ids of entries
    std::uint64_t anchor = 0;                    ///< entry clicked last; Shift selects a range from it
    bool anchor_inside = false;                  ///< the anchor's own row was clicked, not its group's row
    std::set<std::uint64_t> open_groups;         ///< whose entries are listed
    std::vector<OutlinePoint> outline;           ///< of the ink of the selected entries
    bool move_on_drag = false;                   ///< the next drag over the model moves the selected entries
    std::optional<mesh::SurfacePoint> from, to;  ///< of that drag
    SnapshotState snapshots;

    bool is_selected(std::uint64_t id) const { return selected.contains(id); }
};

/// A row of the list: an entry, or a group with its entries.
struct JournalRow {
    std::uint64_t group = 0;         ///< of a group's row; 0: an entry's row
    std::vector<std::size_t> lines;  ///< indices of its entries, in the journal's order
    bool inside = false;             ///< an entry listed under its group
};

/// Returns the rows, newest entry first. A group of at least two entries has its own row at its newest entry. The rows
/// of its entries follow where the group is open.
std::vector<JournalRow> journal_rows(const std::vector<StrokeLine>& lines, const std::set<std::uint64_t>& open_groups);

/// Selects exactly these entries and highlights their ink.
void select_entries(JournalState& journal, PaintThread* work, std::set<std::uint64_t> ids);
/// Shows a snapshot beside the work, in place of the atlas; "": none.
void compare_with(SnapshotState& snapshots, AtlasView& atlas, PaintThread* work, const std::string& snapshot);

}  // namespace tuft::app
