#include "app/session/session.h"

#include <algorithm>
#include <cstdio>

#include "app/session/open_close.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// An ink from the eyedropper or a file comes into the hand; the brush goes on.
void take_picked(Session& s, const std::string& name) {
    s.brush.ink = name;
    if (s.tools.active == Tool::pick) s.tools.active = Tool::brush;
    const ink::Ink* ink = find_ink(s.colours, name);
    if (!ink) return;
    std::string parts;
    for (const ink::InkPart& part : ink->parts) {
        char text[96];
        std::snprintf(text, sizeof text, "%s%.0f %% %s", parts.empty() ? "" : ", ",
                      100 * part.fraction / std::max(1e-9, ink->strength()), part.pigment.name.c_str());
        parts += text;
    }
    show_message(s.status, name + ": " + parts);
}

// The work lies in this file now.
void take_file(Session& s, const fs::path& project) {
    s.project.recovery.note.write(project, s.paint_thread->source());
    if (is_unnamed(project)) return;
    remember_project(project);
    s.project.start_page.recent = recent_projects();
    // The file that it had before it had a name is of no more use, but as what a revised model is made from.
    std::error_code ec;
    if (const fs::path& before = s.reported.project;
        is_unnamed(before) && before != s.project.revision.source && before != s.project.revision.previous)
        fs::remove(before, ec);
}

}  // namespace

void poll_session(Session& s) {
    const bool opened = poll_opening(s);
    poll_paint_thread(s);
    if (opened) choose_brush(s.brush, *s.paint_thread, s.journal.lines, s.tools.pointer.pressure);
    poll_colour(s.colours, s.brush);
}

void poll_paint_thread(Session& s) {
    if (!s.paint_thread) return;
    Update u = s.paint_thread->take();
    if (u.strokes) {
        s.journal.lines = std::move(*u.strokes);
        // What is chosen may be gone, or lie elsewhere.
        std::set<std::uint64_t> there;
        for (const StrokeLine& line : s.journal.lines)
            if (s.journal.holds(line.id)) there.insert(line.id);
        select_entries(s.journal, s.paint_thread.get(), std::move(there));
    }
    if (u.snapshots) s.journal.snapshots.lines = std::move(*u.snapshots);
    if (u.snapshot_picture) s.journal.snapshots.picture = std::move(*u.snapshot_picture);
    u.snapshots.reset();
    u.snapshot_picture.reset();
    if (u.outline) s.journal.outline = std::move(*u.outline);
    u.outline.reset();
    if (u.own_inks) s.colours.own = std::move(*u.own_inks);
    for (Thumbnail& picture : u.thumbnails) {
        s.layers.list.fresh.insert(picture.layer);
        s.layers.list.pictures.insert_or_assign(picture.layer, std::move(picture));
    }
    u.thumbnails.clear();
    if (u.palette) {
        s.colours.palette.picture = std::move(*u.palette);
        s.colours.palette.fresh = true;
        u.palette.reset();
    }
    if (u.not_saved) s.dialogs.file.return_with(u.not_saved->first, u.not_saved->second);
    u.not_saved.reset();
    if (u.looks) s.colours.appearance = std::move(*u.looks);
    if (!u.picked.empty()) take_picked(s, u.picked);
    for (std::string& message : u.messages) show_message(s.status, std::move(message));
    u.messages.clear();
    if (!u.project.empty() && !u.viewing && u.project != s.reported.project) take_file(s, u.project);
    // The scene takes the tiles.
    std::vector<render::TilePixels> tiles = std::move(s.reported.tiles);
    tiles.insert(tiles.end(), u.tiles.begin(), u.tiles.end());
    u.tiles = std::move(tiles);
    if (!u.pixels) u.pixels = std::move(s.reported.pixels);
    if (!u.tuft) u.tuft = std::move(s.reported.tuft);
    follow_layers(s.layers, u.layers, s.reported.layers, u.from_outside, s.paint_thread->idle());
    follow_masks(s.masks, s.paint_thread.get(), u.masks);
    s.reported = std::move(u);
    // What was asked about is on disk now.
    if (s.project.closing.request && !has_unsaved_work(s) && s.paint_thread->idle())
        close_now(s, *s.project.closing.request);
}

bool is_settled(const Session& s) {
    return !s.project.opening.running() && !s.colours.choice.finder.busy() &&
           (!s.paint_thread || s.paint_thread->idle()) && !s.tools.pointer_down;
}

}  // namespace tuft::app
