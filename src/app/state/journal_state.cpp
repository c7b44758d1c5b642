#include "app/state/journal_state.h"

#include <map>

namespace tuft::app {

std::vector<JournalRow> journal_rows(const std::vector<StrokeLine>& lines, const std::set<std::uint64_t>& open_groups) {
    std::map<std::uint64_t, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].group.id != 0) groups[lines[i].group.id].push_back(i);
    std::vector<JournalRow> rows;
    for (std::size_t i = lines.size(); i-- > 0;) {
        const std::uint64_t id = lines[i].group.id;
        const auto group = groups.find(id);
        if (group == groups.end() || group->second.size() < 2) {
            rows.push_back({.lines = {i}});
            continue;
        }
        if (group->second.back() != i) continue;  // listed already
        rows.push_back({.group = id, .lines = group->second});
        if (!open_groups.contains(id)) continue;
        for (std::size_t k = group->second.size(); k-- > 0;)
            rows.push_back({.lines = {group->second[k]}, .inside = true});
    }
    return rows;
}

void select_entries(JournalState& j, PaintThread* work, std::set<std::uint64_t> ids) {
    if (j.selected.empty() && ids.empty()) return;
    j.selected = std::move(ids);
    j.move_on_drag = false;
    j.from.reset();
    j.to.reset();
    if (work) work->post(HighlightStrokes{{j.selected.begin(), j.selected.end()}});
}

void compare_with(SnapshotState& all, AtlasView& atlas, PaintThread* work, const std::string& id) {
    all.compared = id;
    all.ready = false;
    all.picture.reset();
    if (id.empty() || !work) return;
    atlas.shown = false;
    work->post(ShowSnapshot{id});
}

}  // namespace tuft::app
