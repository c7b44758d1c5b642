#include "app/paint/outside_changes.h"

#include <algorithm>
#include <set>

#include "io/project/appearance.h"
#include "io/project/restore.h"

namespace tuft::app {
namespace {

bool has_model(const io::Project& file, const stroke::Model& model) {
    const io::ProjectModel there = file.model();
    return there.mesh.positions == model.mesh->positions && there.mesh.triangles == model.mesh->triangles &&
           there.atlas.size == model.atlas.size && there.atlas.pages == model.atlas.pages &&
           there.atlas.corner_uvs == model.atlas.corner_uvs;
}

template <class Preset>
Preset named(Preset preset, const std::string& name) {
    preset.name = name;
    return preset;
}

// Whether its brush is as the entry before left it.
bool goes_on(const stroke::JournalEntry& entry) {
    const stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    const stroke::BrushAction* action = entry.as<stroke::BrushAction>();
    return (stroke && stroke->settings.dip == stroke::DipMode::persistent) ||
           (action && action->dip == stroke::DipMode::persistent);
}

}  // namespace

void OutsideChanges::poll() {
    if (context_.work.document->session() || !context_.work.autosave.overtaken()) return;
    try {
        take();
    } catch (const std::exception& error) {
        context_.outbox.report(message_of(error));
        context_.publisher.publish(true);
    }
}

// Takes in what another program wrote, and writes what it did not know of after that.
void OutsideChanges::take() {
    Autosave& autosave = context_.work.autosave;
    const bool viewing = autosave.viewing();
    std::optional<io::Project> file = autosave.read_again();
    if (!file) return context_.publisher.publish();
    if (!has_model(*file, *context_.work.model)) return leave_file();
    const std::vector<stroke::JournalEntry> theirs = file->strokes();
    std::vector<stroke::EntryMark> marks = stroke::marks_of(theirs);
    const bool same_strokes = marks == autosave.on_disk() && !autosave.behind();
    stroke::MergedJournal merged =
        stroke::merge_journals(autosave.on_disk(), context_.work.document->journal().entries(), theirs);
    if (!same_strokes) {
        context_.outbox.change([](Update& update) { update.events.from_outside = true; });
    }
    if (!same_strokes)
        paint_merged(*file, merged);
    else
        io::apply_recolouring(*file, *context_.work.document);
    const bool altered = merged.altered && !same_strokes;
    if (viewing)
        autosave.view(std::move(*file), std::move(marks));
    else
        autosave.adopt(std::move(*file), std::move(marks));
    const std::vector<stroke::JournalEntry>& now = context_.work.document->journal().entries();
    if (altered)
        autosave.rewrite(context_.work.source, context_.work.frame, *context_.work.document);
    else if (!viewing)
        autosave.catch_up(std::span(now).subspan(std::min(theirs.size(), now.size())));
    if (merged.news > 0 && !viewing)
        context_.outbox.report(Message(merged.news == 1
                                           ? "Another program changed this project; {} change of it is taken in."
                                           : "Another program changed this project; {} changes of it are taken in.",
                                       merged.news));
    context_.publisher.publish(true);
    context_.publisher.publish_snapshots();
    context_.publisher.publish_appearance();
}

void OutsideChanges::paint_merged(const io::Project& file, const stroke::MergedJournal& merged) {
    const auto shown = [this, name = std::string("Taking in the changes of another program")](std::string_view phase,
                                                                                              double part) {
        context_.progress(name)(phase, part);
        return true;  // half of them would be no journal of anybody
    };
    const auto fresh = [&] {
        auto painting = std::make_unique<stroke::Document>(*context_.work.model);
        context_.take_presets(*painting, {});
        io::use_presets(file, *painting);
        return painting;
    };
    if (follow(file, merged.entries)) return context_.publisher.publish(true);
    auto painting = fresh();
    const auto own = std::span(merged.entries).subspan(merged.from_theirs);
    bool whole = merged.altered || std::ranges::any_of(own, &stroke::JournalEntry::hidden);
    if (!whole) {
        try {
            io::restore_strokes(file, *painting, shown);
            for (const stroke::JournalEntry& entry : own) painting->paint(entry, shown);
        } catch (const Error&) {  // such as on a layer that is locked now
            whole = true;
            painting = fresh();
        }
    }
    if (whole) painting->replay(merged.entries, shown);
    io::apply_recolouring(file, *painting);
    context_.history.reset(painting->journal().entries().size());
    painting->appearance().mark_all_changed();
    context_.replace_document(std::move(painting));
    context_.work.texture->refresh_all(*context_.work.document);  // they may show it otherwise
    context_.publisher.send_texture();
}

// Where they only went on, what they did is done here too.
bool OutsideChanges::follow(const io::Project& file, std::span<const stroke::JournalEntry> theirs) {
    stroke::Document& painting = *context_.work.document;
    const std::vector<stroke::JournalEntry>& mine = painting.journal().entries();
    const std::size_t n = mine.size();
    if (theirs.size() < n || !std::equal(mine.begin(), mine.end(), theirs.begin(), [](const auto& a, const auto& b) {
            return stroke::mark_of(a) == stroke::mark_of(b);
        }))
        return false;
    const std::span<const stroke::JournalEntry> rest = theirs.subspan(n);
    std::set<std::string> brushes, inks;
    for (const stroke::JournalEntry& s : rest) {
        if (!stroke::has_brush(stroke::kind_of(s))) continue;
        const std::string& brush = stroke::brush_of(s);
        if (goes_on(s) && !brushes.contains(brush) && !painting.brushes().find(brush)) return false;
        brushes.insert(brush);
    }
    for (const stroke::JournalEntry& s : rest)
        for (const std::string& ink : stroke::inks_of(s)) inks.insert(ink);
    for (const stroke::JournalEntry& s : mine) {
        brushes.erase(stroke::brush_of(s));
        for (const std::string& ink : stroke::inks_of(s)) inks.erase(ink);
    }
    for (const auto& [name, toml] : file.brushes())
        if (brushes.contains(name)) painting.use(named(brush::parse_preset(toml, name), name));
    for (const auto& [name, toml] : file.inks())
        if (inks.contains(name)) painting.use(named(ink::parse_ink(toml, name), name));
    painting.replay({rest.begin(), rest.end()}, {});
    context_.history.done.resize(theirs.size(), EditStep{.made = 1});
    context_.history.undone.clear();
    return true;
}

// Another model lies where the project was: what is here goes on in a file of its own.
void OutsideChanges::leave_file() {
    const std::string name = context_.work.autosave.path().filename().string();
    const bool viewing = context_.work.autosave.viewing();
    const Message fault = context_.work.autosave.start(context_.work.spare, context_.work.source, context_.work.frame,
                                                       *context_.work.document);
    if (!fault.empty())
        context_.work.autosave.start_later(context_.work.spare, context_.work.source, context_.work.frame, fault,
                                           !context_.work.document->journal().empty());
    context_.outbox.report(
        viewing
            ? Message("Another program put another model into {}; this is a copy of what was in it.", name)
            : Message("Another program put another model into {}; your work goes on in a copy that has no name yet.",
                      name));
    context_.publisher.publish();
}

}  // namespace tuft::app
