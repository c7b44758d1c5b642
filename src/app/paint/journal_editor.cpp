#include "app/paint/journal_editor.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "brush/preset/preset.h"

namespace tuft::app {
namespace {

Vec3 moved(const RigidMove& move, const Vec3& p) {
    return move.to + move.rotation * (p - move.from);
}
void shift(stroke::Placement& place, const RigidMove& move) {
    place = {moved(move, place.origin), move.rotation * place.right, move.rotation * place.down, place.mapping};
}

void shift(stroke::JournalEntry& entry, const RigidMove& move) {
    if (stroke::Fill* fill = entry.as<stroke::Fill>(); fill && fill->area) shift(fill->area->placement, move);
    stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    if (!stroke) return;
    if (stroke->trace.flat) return shift(stroke->trace.placement, move);
    for (stroke::StrokeSample& s : stroke->trace.samples) {
        s.position = moved(move, s.position);
        s.rotation = glm::normalize(move.rotation * s.rotation);
    }
}

// Another make of brush in the size that the stroke was painted with.
std::string rebrushed(const std::string& before, const std::string& wanted) {
    return brush::name_of({brush::sized_name(wanted).base, brush::sized_name(before).factor});
}

bool has_ink_of_its_own(const stroke::JournalEntry& entry) {
    const stroke::EntryKind kind = stroke::kind_of(entry);
    return !stroke::ink_of(entry).empty() &&
           (kind == stroke::EntryKind::stroke || kind == stroke::EntryKind::dip || kind == stroke::EntryKind::fill);
}

}  // namespace

void JournalEditor::add(stroke::JournalEntry entry) {
    strokes_.cancel();
    context_.work.document->paint(std::move(entry));
    context_.work.autosave.add(context_.work.document->journal().entries().back());
    context_.history.add({.made = 1});
    context_.publisher.publish(true);
}

void JournalEditor::undo() {
    strokes_.cancel();
    const auto start = std::chrono::steady_clock::now();
    for (bool more = true; more && !context_.history.done.empty();) {
        const EditStep& step = context_.history.done.back();
        more = step.joined;
        if (!step.changes.empty()) put(step.changes, true);
        if (step.journal) put_journal(step.journal->before);
        for (std::size_t i = 0; i < step.made && context_.work.document->journal().can_undo(); ++i) {
            const std::uint64_t id = context_.work.document->journal().entries().back().id;
            context_.work.document->undo();
            context_.work.autosave.remove(id);
        }
        context_.history.undone.push_back(std::move(context_.history.done.back()));
        context_.history.done.pop_back();
    }
    context_.publisher.set_undo_seconds(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    context_.publisher.publish(true);
}

void JournalEditor::redo() {
    strokes_.cancel();
    for (bool more = true; more && !context_.history.undone.empty();
         more = !context_.history.undone.empty() && context_.history.undone.back().joined) {
        const EditStep& step = context_.history.undone.back();
        if (!step.changes.empty()) put(step.changes, false);
        if (step.journal) put_journal(step.journal->after);
        for (std::size_t i = 0; i < step.made; ++i)
            if (context_.work.document->redo())
                context_.work.autosave.add(context_.work.document->journal().entries().back());
        context_.history.done.push_back(std::move(context_.history.undone.back()));
        context_.history.undone.pop_back();
    }
    context_.publisher.publish(true);
}

void JournalEditor::edit(const EditStrokes& command) {
    strokes_.cancel();
    const stroke::Journal& journal = context_.work.document->journal();
    const std::set<std::uint64_t> wanted(command.ids.begin(), command.ids.end());
    const stroke::EntryGroup group = command.group && !command.group->empty()
                                         ? stroke::EntryGroup{journal.next_group_id(), *command.group}
                                         : stroke::EntryGroup{};
    if (group.id != 0) stroke::check_name(group.name, "group");
    const bool in_rows =
        command.remove || (command.hidden && !command.brush && !command.ink && !command.move && !command.group);
    std::vector<EntryChange> changes;
    for (std::size_t i = 0; i < journal.entries().size(); ++i) {
        const stroke::JournalEntry& before = journal.entries()[i];
        if (!wanted.contains(before.id)) continue;
        EntryChange change{.at = i, .before = before, .after = {}, .in_rows = in_rows};
        if (!command.remove) {
            stroke::JournalEntry& after = change.after.emplace(before);
            if (command.hidden) after.hidden = *command.hidden;
            if (command.brush && stroke::has_brush(stroke::kind_of(before)))
                stroke::set_brush(after, rebrushed(stroke::brush_of(before), *command.brush));
            if (command.ink && has_ink_of_its_own(before)) stroke::set_ink(after, *command.ink);
            if (command.move) shift(after, *command.move);
            if (command.group) after.group = group;
            const std::string &brush = stroke::brush_of(after), &ink = stroke::ink_of(after);
            if (brush != stroke::brush_of(before) || ink != stroke::ink_of(before))
                context_.work.autosave.prepare(*context_.work.document, brush, ink);
        }
        changes.push_back(std::move(change));
    }
    if (changes.empty()) return;
    put(changes, false);
    context_.work.document->restore_undone({});
    context_.history.add({.changes = std::move(changes)});
    context_.publisher.publish(true);
}

// What is there now goes into the step that undo takes back.
void JournalEditor::restore(std::vector<stroke::JournalEntry> entries) {
    strokes_.cancel();
    std::vector<stroke::JournalEntry> before = context_.work.document->journal().entries();
    put_journal(entries);
    context_.work.document->restore_undone({});
    context_.history.add({.journal = JournalChange{std::move(before), std::move(entries)}});
}

// Changes entries, or changes them back, and paints all strokes anew.
void JournalEditor::put(const std::vector<EntryChange>& changes, bool back) {
    std::vector<stroke::JournalEntry> strokes = context_.work.document->journal().entries();
    const auto at = [&](const EntryChange& change) { return strokes.begin() + static_cast<std::ptrdiff_t>(change.at); };
    if (back)
        for (const EntryChange& change : changes)
            change.after ? void(*at(change) = change.before) : void(strokes.insert(at(change), change.before));
    else
        for (auto change = changes.rbegin(); change != changes.rend(); ++change)
            change->after ? void(*at(*change) = *change->after) : void(strokes.erase(at(*change)));
    repaint(std::move(strokes));
    // Rows can only be hidden and taken out: other changes, and several at once, write the file anew, whole or not at
    // all.
    const EntryChange& first = changes.front();
    const bool one_row = changes.size() == 1 && first.in_rows;
    if (one_row && !first.after && !back)
        context_.work.autosave.remove(first.before.id);
    else if (one_row && first.after)
        context_.work.autosave.set_hidden(first.before.id, back ? first.before.hidden : first.after->hidden);
    else
        context_.work.autosave.rewrite(context_.work.source, context_.work.frame, *context_.work.document);
}

void JournalEditor::put_journal(const std::vector<stroke::JournalEntry>& entries) {
    repaint(entries);
    context_.work.autosave.rewrite(context_.work.source, context_.work.frame, *context_.work.document);
}

// Paints all strokes anew beside what is there, then puts it in its place.
void JournalEditor::repaint(std::vector<stroke::JournalEntry> strokes) {
    stroke::Document& old = *context_.work.document;
    auto painting = std::make_unique<stroke::Document>(*context_.work.model);
    context_.take_presets(*painting, strokes);  // a change may name new ones
    painting->replay(std::move(strokes), context_.progress("Painting again"));
    painting->restore_undone(old.journal().undone());
    context_.replace_document(std::move(painting));
}

}  // namespace tuft::app
