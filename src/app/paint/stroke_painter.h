#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Painting of strokes and drawings. Paint thread.
namespace tuft::app {

/// Paints the current stroke with its symmetric copies, and placed drawings.
class StrokePainter {
  public:
    explicit StrokePainter(PaintContext& context) : context_(context) {}

    /// Begins a stroke with its first pose still to come.
    void begin(const BeginStroke& command);
    /// `goes_on`: another command that extends the stroke comes next.
    void extend(const ExtendStroke& command, bool goes_on);
    void end();
    /// Drops the current stroke, if any.
    void cancel();
    /// Removes the loading entries of a stroke that was never painted, and restores the redo list.
    void drop_loads();
    void paint_drawing(PaintDrawing& command);
    /// Makes the motions of a text, then paints them as a drawing's.
    void paint_text(PaintText& command);

  private:
    void load_tip(const BeginStroke& command, std::size_t& made);
    void add_copies(const stroke::JournalEntry& original, std::size_t& made);
    std::function<double(const std::string&)> film_of_inks() const;
    std::vector<stroke::JournalEntry> entries_of(PaintDrawing& command);
    void direct(std::vector<stroke::JournalEntry>& entries, const GroupSettings& settings);
    void paint_group(std::vector<stroke::JournalEntry> entries, const GroupSettings& settings, const ProgressFn& shown);

    PaintContext& context_;
    BeginStroke current_;
    std::size_t loads_ = 0;                            ///< entries that loaded the brush for the current stroke
    std::vector<stroke::JournalEntry> undone_before_;  ///< redo list before them
    stroke::WidthTables widths_;
};

}  // namespace tuft::app
