#include "app/session/session.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "app/session/open_close.h"
#include "app/session/open_files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// An ink from the eyedropper or a file comes into the hand; the brush goes on.
void take_picked(Session& s, const std::string& name) {
    s.brush.ink = name;
    if (s.tools.active == Tool::pick) s.tools.active = Tool::brush;
    const ink::Ink* ink = find_ink(s.colours, name);
    if (!ink) return;
    std::vector<Message> parts;
    for (const ink::InkPart& part : ink->parts)
        parts.emplace_back("{} % {}", std::lround(100 * part.fraction / std::max(1e-9, ink->strength())),
                           pigment_key(part.pigment.name).c_str());
    show_message(s.status, Message("{}: {}", name, join(parts)));
}

// The work lies in this file now.
void take_file(Session& s, const fs::path& project) {
    s.project.recovery.note.write(project, s.paint_thread->source());
    if (is_unnamed(project)) return;
    remember_project(project);
    s.project.start_page.recent = recent_projects();
    // The file that it had before it had a name is of no more use, but as what a revised model is made from.
    std::error_code ec;
    if (const fs::path& before = s.reported.file.project;
        is_unnamed(before) && before != s.project.revision.source && before != s.project.revision.previous)
        fs::remove(before, ec);
}

void take_lines(JournalState& journal, PaintThread& work, std::vector<StrokeLine> lines) {
    journal.lines = std::move(lines);
    // What is chosen may be gone, or lie elsewhere.
    std::set<std::uint64_t> there;
    for (const StrokeLine& line : journal.lines)
        if (journal.is_selected(line.id)) there.insert(line.id);
    select_entries(journal, &work, std::move(there));
}

void take_events(Session& s, PaintEvents& e) {
    // The scene has not taken those before yet.
    if (e.texels.pixels) s.view.texels.pixels = std::move(e.texels.pixels);
    std::vector<render::TilePixels>& tiles = s.view.texels.tiles;
    tiles.insert(tiles.end(), std::make_move_iterator(e.texels.tiles.begin()),
                 std::make_move_iterator(e.texels.tiles.end()));
    if (e.strokes) take_lines(s.journal, *s.paint_thread, std::move(*e.strokes));
    if (e.snapshots) s.journal.snapshots.lines = std::move(*e.snapshots);
    if (e.snapshot_picture) s.journal.snapshots.picture = std::move(e.snapshot_picture);
    if (e.outline) s.journal.outline = std::move(*e.outline);
    for (Thumbnail& picture : e.thumbnails) {
        s.layers.list.fresh.insert(picture.layer);
        s.layers.list.pictures.insert_or_assign(picture.layer, std::move(picture));
    }
    if (e.palette) {
        s.colours.palette.picture = std::move(*e.palette);
        s.colours.palette.fresh = true;
    }
    if (e.own_inks) s.colours.own = std::move(*e.own_inks);
    if (e.appearance) s.colours.appearance = std::move(*e.appearance);
    if (!e.picked.empty()) take_picked(s, e.picked);
    if (e.not_saved) s.dialogs.file.return_with(e.not_saved->path, e.not_saved->reason);
    for (Message& message : e.messages) show_message(s.status, std::move(message));
}

}  // namespace

void poll_session(Session& s) {
    const bool opened = poll_opening(s);
    poll_paint_thread(s);
    if (opened) {
        Message away = choose_brush(s.brush, *s.paint_thread, s.journal.lines, s.tools.pointer.pressure);
        if (!away.empty() && s.status.text.empty()) show_message(s.status, std::move(away));
    }
    s.brush.shelf.watch(s.brush.presets, brush::sized_name(s.brush.preset).base);
    poll_colour(s.colours, s.brush);
    s.tools.letters.update(s.tools.lettering);
    store_read_copies(s);
    // Painting a stroke of the hand comes first.
    s.brush.tried.update(!s.tools.pointer_down && !s.project.opening.running() &&
                         (!s.paint_thread || s.paint_thread->idle()));
}

void poll_paint_thread(Session& s) {
    if (!s.paint_thread) return;
    Update update = s.paint_thread->take();
    take_events(s, update.events);
    const PaintStatus& now = update.status;
    if (!now.file.project.empty() && !now.file.viewing && now.file.project != s.reported.file.project)
        take_file(s, now.file.project);
    follow_layers(s.layers, now.document.layers, s.reported.document.layers, update.events.from_outside,
                  s.paint_thread->idle());
    follow_masks(s.masks, s.paint_thread.get(), now.document.masks);
    s.reported = std::move(update.status);
    // What was asked about is on disk now.
    if (s.project.closing.request && !has_unsaved_work(s) && s.paint_thread->idle())
        close_now(s, *s.project.closing.request);
}

bool is_settled(const Session& s) {
    return !s.project.opening.running() && !s.colours.choice.finder.busy() &&
           !s.tools.letters.busy(s.tools.lettering) && !s.tools.copies.busy() && !s.dialogs.file.busy() &&
           (!s.paint_thread || s.paint_thread->idle()) && !s.tools.pointer_down;
}

}  // namespace tuft::app
