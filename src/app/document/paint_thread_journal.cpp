#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "app/document/paint_thread.h"
#include "brush/preset/preset.h"

/// Going back over the journal, and changing what is in it: on the painter's thread.
namespace tuft::app {
namespace {

void shift(stroke::Stroke& stroke, const RigidMove& move) {
    const auto moved = [&](const Vec3& p) { return move.to + move.rotation * (p - move.from); };
    stroke::Placement& place = stroke.trace.placement;
    if (stroke.trace.flat) {
        place = {moved(place.origin), move.rotation * place.right, move.rotation * place.down, place.mapping};
        return;
    }
    for (stroke::TraceSample& s : stroke.trace.samples) {
        s.position = moved(s.position);
        s.rotation = glm::normalize(move.rotation * s.rotation);
    }
}

// Another make of brush in the size that the stroke was painted with.
std::string rebrushed(const std::string& before, const std::string& wanted) {
    return brush::name_of({brush::sized_name(wanted).base, brush::sized_name(before).factor});
}

bool has_ink_of_its_own(const stroke::Stroke& entry) {
    return !entry.trace.ink.empty() && (entry.action == stroke::Action::stroke || entry.action == stroke::Action::dip ||
                                        entry.action == stroke::Action::fill);
}

}  // namespace

void PaintThread::undo() {
    cancel();
    const auto start = std::chrono::steady_clock::now();
    for (bool more = true; more && !steps_.empty();) {
        const Step& step = steps_.back();
        more = step.joined;
        if (!step.changes.empty()) put(step.changes, true);
        if (step.journals) put_journal(step.journals->before);
        for (std::size_t i = 0; i < step.made && work_.painting->journal().can_undo(); ++i) {
            const std::uint64_t id = work_.painting->journal().strokes().back().id;
            work_.painting->undo();
            work_.autosave.remove(id);
        }
        undone_.push_back(std::move(steps_.back()));
        steps_.pop_back();
    }
    undo_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    publish(true);
}

void PaintThread::redo() {
    cancel();
    for (bool more = true; more && !undone_.empty(); more = !undone_.empty() && undone_.back().joined) {
        const Step& step = undone_.back();
        if (!step.changes.empty()) put(step.changes, false);
        if (step.journals) put_journal(step.journals->after);
        for (std::size_t i = 0; i < step.made; ++i)
            if (work_.painting->redo()) work_.autosave.add(work_.painting->journal().strokes().back());
        steps_.push_back(std::move(undone_.back()));
        undone_.pop_back();
    }
    publish(true);
}

void PaintThread::edit(const EditStrokes& command) {
    cancel();
    const stroke::Journal& journal = work_.painting->journal();
    const std::set<std::uint64_t> wanted(command.ids.begin(), command.ids.end());
    const stroke::EntryGroup group = command.group && !command.group->empty()
                                         ? stroke::EntryGroup{journal.next_group_id(), *command.group}
                                         : stroke::EntryGroup{};
    if (group.id != 0) stroke::check_name(group.name, "group");
    const bool in_rows =
        command.remove || (command.hidden && !command.brush && !command.ink && !command.move && !command.group);
    std::vector<Change> changes;
    for (std::size_t i = 0; i < journal.strokes().size(); ++i) {
        const stroke::Stroke& before = journal.strokes()[i];
        if (!wanted.contains(before.id)) continue;
        Change change{.at = i, .before = before, .after = {}, .in_rows = in_rows};
        if (!command.remove) {
            stroke::Stroke& after = change.after.emplace(before);
            if (command.hidden) after.hidden = *command.hidden;
            if (command.brush && stroke::has_brush(before.action))
                after.trace.brush = rebrushed(before.trace.brush, *command.brush);
            if (command.ink && has_ink_of_its_own(before)) after.trace.ink = *command.ink;
            if (command.move) shift(after, *command.move);
            if (command.group) after.group = group;
            if (after.trace.brush != before.trace.brush || after.trace.ink != before.trace.ink)
                work_.autosave.prepare(*work_.painting, after.trace.brush, after.trace.ink);
        }
        changes.push_back(std::move(change));
    }
    if (changes.empty()) return;
    put(changes, false);
    work_.painting->restore_undone({});
    undone_.clear();
    steps_.push_back({.changes = std::move(changes)});
    publish(true);
}

// Changes entries, or changes them back, and paints all strokes anew.
void PaintThread::put(const std::vector<Change>& changes, bool back) {
    std::vector<stroke::Stroke> strokes = work_.painting->journal().strokes();
    const auto at = [&](const Change& change) { return strokes.begin() + static_cast<std::ptrdiff_t>(change.at); };
    if (back)
        for (const Change& change : changes)
            change.after ? void(*at(change) = change.before) : void(strokes.insert(at(change), change.before));
    else
        for (auto change = changes.rbegin(); change != changes.rend(); ++change)
            change->after ? void(*at(*change) = *change->after) : void(strokes.erase(at(*change)));
    rewrite(std::move(strokes));
    // Rows can only be hidden and taken out: other changes, and several at once, write the file anew, whole or not at
    // all.
    const Change& first = changes.front();
    const bool one_row = changes.size() == 1 && first.in_rows;
    if (one_row && !first.after && !back)
        work_.autosave.remove(first.before.id);
    else if (one_row && first.after)
        work_.autosave.set_hidden(first.before.id, back ? first.before.hidden : first.after->hidden);
    else
        work_.autosave.rewrite(work_.source, work_.frame, *work_.painting);
}

// Puts other entries in the place of the whole journal.
void PaintThread::put_journal(const std::vector<stroke::Stroke>& entries) {
    rewrite(entries);
    work_.autosave.rewrite(work_.source, work_.frame, *work_.painting);
}

// BaseColour and looks of the work, and the brushes and inks that its entries and these use.
void PaintThread::take_presets(stroke::Document& painting, const std::vector<stroke::Stroke>& entries) {
    stroke::Document& own = *work_.painting;
    painting.use_substrate(own.painted_on());
    if (own.has_preview_substrate()) painting.preview_substrate(own.substrate());
    for (const ink::Ink& ink : own_inks_) painting.use_ink(ink);  // also those that no entry uses now
    for (const std::vector<stroke::Stroke>* of : {&own.journal().strokes(), &entries})
        for (const stroke::Stroke& s : *of) {
            if (stroke::has_brush(s.action)) painting.use_brush(own.brush(s.trace.brush));
            if (!s.trace.ink.empty()) painting.use_ink(own.ink(s.trace.ink));
            for (const std::string& ink : stroke::inks_of(s)) painting.use_ink(own.ink(ink));
        }
    for (const auto& [name, wanted] : own.recolours()) {
        painting.use_ink(own.ink(name));
        painting.recolour(name, wanted);
    }
}

// Paints all strokes anew beside what is there, then puts it in its place.
void PaintThread::rewrite(std::vector<stroke::Stroke> strokes) {
    stroke::Document& old = *work_.painting;
    auto painting = std::make_unique<stroke::Document>(*work_.model);
    take_presets(*painting, strokes);  // a change may name new ones
    painting->replay(std::move(strokes), progress("Document again"));
    painting->restore_undone(old.journal().undone());
    replace_painting(std::move(painting));
}

// The same model with other strokes on it.
void PaintThread::replace_painting(std::unique_ptr<stroke::Document> painting) {
    for (const stroke::LayerTexels& layer : work_.painting->canvases())
        for (const std::uint32_t slot : layer.canvas->touched_slots()) painting->canvas().mark_dirty(slot);
    work_.painting = std::move(painting);
    lines_.clear();
    if (!palette_.rgb.empty()) {
        refresh(palette_, *work_.painting);
        const std::lock_guard lock(mutex_);
        update_.palette = palette_;
    }
    publish(true);
}

}  // namespace tuft::app
