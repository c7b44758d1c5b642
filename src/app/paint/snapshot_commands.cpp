#include "app/paint/snapshot_commands.h"

#include <algorithm>
#include <ctime>

#include "app/document/snapshots.h"

namespace tuft::app {
namespace {

std::vector<stroke::JournalEntry> snapshot_entries(const PaintContext& context, const std::string& id) {
    const std::optional<io::Attachment> found = context.work.autosave.attachment(io::kSnapshots, id);
    if (!found) throw Error("there is no such snapshot any more");
    return io::unpack_entries(found->bytes, "the snapshot '" + line_of(*found).name + "'");
}

}  // namespace

void take_snapshot(PaintContext& context, const TakeSnapshot& command) {
    stroke::check_name(command.name, "snapshot");
    const std::vector<io::Attachment> there = context.work.autosave.attachments(io::kSnapshots);
    if (there.size() >= io::kMostAttachments)
        return context.outbox.report("There are as many snapshots as a project can hold; delete one first.");
    const std::vector<stroke::JournalEntry>& entries = context.work.document->journal().entries();
    SnapshotLine line{.name = command.name, .made = static_cast<std::int64_t>(std::time(nullptr))};
    line.strokes = static_cast<std::size_t>(std::count_if(
        entries.begin(), entries.end(), [](const auto& s) { return s.template as<stroke::PaintStroke>() != nullptr; }));
    // Numbers in names sort as they were made.
    const unsigned long last = there.empty() ? 0 : std::strtoul(there.back().name.c_str(), nullptr, 10);
    char id[24];
    std::snprintf(id, sizeof id, "%08lu", last + 1);
    context.work.autosave.attach(io::kSnapshots, {id, about_text(line), io::pack_entries(entries)});
    context.publisher.publish();
    context.publisher.publish_snapshots();
}

void rename_snapshot(PaintContext& context, const RenameSnapshot& command) {
    stroke::check_name(command.name, "snapshot");
    const std::optional<io::Attachment> found = context.work.autosave.attachment(io::kSnapshots, command.id);
    if (!found) return;
    SnapshotLine line = line_of(*found);
    line.name = command.name;
    context.work.autosave.attach(io::kSnapshots, {found->name, about_text(line), found->bytes});
    context.publisher.publish_snapshots();
}

void show_snapshot(PaintContext& context, const ShowSnapshot& command) {
    const std::vector<stroke::JournalEntry> entries = snapshot_entries(context, command.id);
    stroke::Document painting(*context.work.model);
    context.take_presets(painting, entries);
    painting.replay(entries, context.progress("Painting the snapshot"));
    SnapshotPicture picture{command.id, Texture(painting).pixels()};
    context.publisher.publish();
    context.outbox.change([&](Update& update) { update.events.snapshot_picture = std::move(picture); });
}

void restore_snapshot(PaintContext& context, JournalEditor& journal, const RestoreSnapshot& command) {
    journal.restore(snapshot_entries(context, command.id));
    context.outbox.report("The snapshot is restored; Undo brings back what was there.");
    context.publisher.publish(true);
}

}  // namespace tuft::app
