#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/document/thumbnails.h"
#include "app/work/commands.h"
#include "app/work/edit_history.h"
#include "app/work/outbox.h"
#include "app/work/paint_work.h"

namespace tuft::app {

/// Finds out what changed in the work and puts it into the outbox. On the paint thread, or before there is one.
class Publisher {
  public:
    Publisher(PaintWork& work, const EditHistory& history, Outbox& outbox);

    /// Hands over tiles that changed and the status; with `journal_changed` the list of entries, too.
    void publish(bool journal_changed = false);
    /// `publish`, unless the last time is no longer ago than the eye can tell.
    void publish_if_due();
    /// Hands over the whole texture anew.
    void send_texture();
    void send_tiles(std::vector<render::TilePixels> tiles);
    void publish_appearance();
    void publish_snapshots();
    /// Hands over small pictures of layers that changed. `camera`: from where they are seen from now on.
    void draw_thumbnails();
    void look_from(const render::GlCamera& camera);
    /// The document shall be shown otherwise as a whole.
    void forget_thumbnails() { thumbnails_.forget(); }
    /// Another document took the place of the one before: all entries and the palette are handed over anew.
    void forget_journal();

    /// The brush painted with, and whether it is on the palette.
    void set_brush(const std::string& name, bool on_palette);
    void set_done(double asked) { done_ = asked; }
    void set_undo_seconds(double seconds) { undo_seconds_ = seconds; }

  private:
    void update_lines();
    void update_brush_colour();

    PaintWork& work_;
    const EditHistory& history_;
    Outbox& outbox_;
    Thumbnails thumbnails_;
    std::vector<StrokeLine> lines_;
    stroke::PalettePicture palette_;
    std::string brush_;
    bool on_palette_ = false;
    std::optional<std::array<std::uint8_t, 3>> brush_colour_;
    double undo_seconds_ = 0, done_ = 0, last_publish_ = 0;
};

}  // namespace tuft::app
