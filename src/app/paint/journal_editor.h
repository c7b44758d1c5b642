#pragma once

#include <vector>

#include "app/paint/stroke_painter.h"
#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Changes of the journal with undo. Paint thread.
namespace tuft::app {

/// Appends, undoes, redoes and edits entries, and repaints what changed.
class JournalEditor {
  public:
    JournalEditor(PaintContext& context, StrokePainter& strokes) : context_(context), strokes_(strokes) {}

    /// Appends an entry and applies it.
    void add(stroke::JournalEntry entry);
    /// Joins the last step with the one before it: one undo reverts both.
    void join_last() { context_.history.done.back().joined = true; }
    /// Take back the last step, perform it again, and change entries of the journal.
    void undo();
    void redo();
    void edit(const EditStrokes& command);
    /// Replaces the whole journal.
    void restore(std::vector<stroke::JournalEntry> entries);

  private:
    void put(const std::vector<EntryChange>& changes, bool back);
    void put_journal(const std::vector<stroke::JournalEntry>& entries);
    void repaint(std::vector<stroke::JournalEntry> strokes);

    PaintContext& context_;
    StrokePainter& strokes_;
};

}  // namespace tuft::app
