#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/document/pictures/thumbnails.h"
#include "app/work/commands.h"
#include "app/work/edit_history.h"
#include "app/work/outbox.h"
#include "app/work/paint_work.h"

/// \file
/// From the document to the outbox.
namespace tuft::app {

/// Finds the changes of the work and puts them into the outbox. Paint thread, or before it starts.
class Publisher {
  public:
    Publisher(PaintWork& work, const EditHistory& history, Outbox& outbox);

    /// Sends changed tiles and the status; with `journal_changed` also the list of entries.
    void publish(bool journal_changed = false);
    /// Calls `publish`, at most once per frame of the window and for at most a quarter of the time.
    void publish_if_due();
    /// Sends the whole texture.
    void send_texture();
    void send_tiles(std::vector<render::TilePixels> tiles);
    void publish_appearance();
    void publish_snapshots();
    /// Sends changed thumbnails of layers. `camera`: their view from now on.
    void draw_thumbnails();
    void look_from(const render::GlCamera& camera);
    /// Drops all thumbnails, because the document is shown differently.
    void forget_thumbnails() { thumbnails_.forget(); }
    /// Sends all entries and the palette again, because the document was replaced.
    void forget_journal();

    /// Sets the brush last painted with, and whether it is on the palette.
    void set_brush(const std::string& name, bool on_palette);
    void set_done(double requested_at) { done_ = requested_at; }
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
    double undo_seconds_ = 0, done_ = 0, last_publish_ = 0, publish_seconds_ = 0;
};

}  // namespace tuft::app
