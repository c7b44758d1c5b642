#pragma once

#include <vector>

#include "app/paint/stroke_painter.h"
#include "app/work/commands.h"
#include "app/work/paint_context.h"

namespace tuft::app {

/// Adds entries to the journal, goes back over it, and changes what is in it.
class JournalEditor {
  public:
    JournalEditor(PaintContext& context, StrokePainter& strokes) : context_(context), strokes_(strokes) {}

    /// An entry that is done at once.
    void add(stroke::JournalEntry entry);
    /// The step before is undone together with the last one.
    void join_last() { context_.history.done.back().joined = true; }
    void undo();
    void redo();
    void edit(const EditStrokes& command);
    /// Puts other entries in the place of the whole journal.
    void restore(std::vector<stroke::JournalEntry> entries);

  private:
    void put(const std::vector<EntryChange>& changes, bool back);
    void put_journal(const std::vector<stroke::JournalEntry>& entries);
    void repaint(std::vector<stroke::JournalEntry> strokes);

    PaintContext& context_;
    StrokePainter& strokes_;
};

}  // namespace tuft::app
