#pragma once

#include <cstddef>
#include <vector>

#include "app/work/commands.h"
#include "app/work/paint_context.h"

namespace tuft::app {

/// Paints the stroke in hand with its symmetric copies, and drawings that were placed.
class StrokePainter {
  public:
    explicit StrokePainter(PaintContext& context) : context_(context) {}

    void begin(const BeginStroke& command);
    void extend(const ExtendStroke& command);
    void end();
    /// Drops the stroke in hand, if there is one.
    void cancel();
    /// A stroke that does not come leaves no entry of its loading, and what could be redone before it still can.
    void drop_loads();
    void paint_drawing(PaintDrawing& command);

  private:
    void load_tip(const BeginStroke& command, std::size_t& made);
    void add_copies(const stroke::JournalEntry& original, std::size_t& made);
    std::vector<stroke::JournalEntry> entries_of(PaintDrawing& command);

    PaintContext& context_;
    BeginStroke current_;
    std::size_t loads_ = 0;                            ///< entries that loaded the brush for the stroke in work
    std::vector<stroke::JournalEntry> undone_before_;  ///< what could be redone before them
    stroke::WidthTables widths_;
};

}  // namespace tuft::app
