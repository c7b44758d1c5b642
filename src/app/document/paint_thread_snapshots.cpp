#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app/document/paint_thread.h"

/// Named states of the journal: taking, showing and restoring them, on the painter's thread.
namespace tuft::app {
namespace {

constexpr const char* kSnapshotKind = io::kSnapshots;

SnapshotLine line_of(const io::Attachment& a) {
    SnapshotLine line{.id = a.name, .name = a.name};
    try {
        const nlohmann::json j = nlohmann::json::parse(a.about);
        line.name = j.value("name", line.name);
        // Nothing but whole numbers: the conversion from 1e300 is undefined.
        if (const auto at = j.find("made"); at != j.end() && at->is_number_integer())
            line.made = at->get<std::int64_t>();
        if (const auto at = j.find("strokes"); at != j.end() && at->is_number_unsigned())
            line.strokes = at->get<std::size_t>();
    } catch (const nlohmann::json::exception&) {
        // It is listed by its number.
    }
    return line;
}

std::string about_text(const SnapshotLine& line) {
    return nlohmann::json{{"name", line.name}, {"made", line.made}, {"strokes", line.strokes}}.dump();
}

}  // namespace

void PaintThread::publish_snapshots() {
    std::vector<SnapshotLine> lines;
    for (const io::Attachment& a : work_.autosave.attachments(kSnapshotKind)) lines.push_back(line_of(a));
    const std::lock_guard lock(mutex_);
    update_.snapshots = std::move(lines);
}

void PaintThread::take_snapshot(const TakeSnapshot& command) {
    stroke::check_name(command.name, "snapshot");
    const std::vector<io::Attachment> there = work_.autosave.attachments(kSnapshotKind);
    if (there.size() >= io::kMostAttachments)
        return say("There are as many snapshots as a project can hold; delete one first.");
    const std::vector<stroke::Stroke>& entries = work_.painting->journal().strokes();
    SnapshotLine line{.name = command.name, .made = static_cast<std::int64_t>(std::time(nullptr))};
    line.strokes = static_cast<std::size_t>(std::count_if(
        entries.begin(), entries.end(), [](const auto& s) { return s.action == stroke::Action::stroke; }));
    // Numbers in names sort as they were made.
    const unsigned long last = there.empty() ? 0 : std::strtoul(there.back().name.c_str(), nullptr, 10);
    char id[24];
    std::snprintf(id, sizeof id, "%08lu", last + 1);
    work_.autosave.attach(kSnapshotKind, {id, about_text(line), io::pack_entries(entries)});
    publish();
    publish_snapshots();
}

void PaintThread::rename_snapshot(const RenameSnapshot& command) {
    stroke::check_name(command.name, "snapshot");
    const std::optional<io::Attachment> found = work_.autosave.attachment(kSnapshotKind, command.id);
    if (!found) return;
    SnapshotLine line = line_of(*found);
    line.name = command.name;
    work_.autosave.attach(kSnapshotKind, {found->name, about_text(line), found->bytes});
    publish_snapshots();
}

std::vector<stroke::Stroke> PaintThread::snapshot_entries(const std::string& id) const {
    const std::optional<io::Attachment> found = work_.autosave.attachment(kSnapshotKind, id);
    if (!found) throw Error("there is no such snapshot any more");
    return io::unpack_entries(found->bytes, "the snapshot '" + line_of(*found).name + "'");
}

void PaintThread::show_snapshot(const ShowSnapshot& command) {
    const std::vector<stroke::Stroke> entries = snapshot_entries(command.id);
    stroke::Document painting(*work_.model);
    take_presets(painting, entries);
    painting.replay(entries, progress("Document the snapshot"));
    SnapshotPicture picture{command.id, Texture(painting).pixels()};
    publish();
    const std::lock_guard lock(mutex_);
    update_.snapshot_picture = std::move(picture);
}

// What is there now goes into the step that undo takes back.
void PaintThread::restore_snapshot(const RestoreSnapshot& command) {
    cancel();
    std::vector<stroke::Stroke> entries = snapshot_entries(command.id), before = work_.painting->journal().strokes();
    put_journal(entries);
    work_.painting->restore_undone({});
    undone_.clear();
    steps_.push_back({.journals = Journals{std::move(before), std::move(entries)}});
    say("The snapshot is restored; Undo brings back what was there.");
    publish(true);
}

}  // namespace tuft::app
