#pragma once

#include "app/paint/journal_editor.h"
#include "app/work/commands.h"

/// \file
/// Commands that append one entry to the journal. Paint thread.
namespace tuft::app {

/// Perform the command, append its entry and store it. What cannot be done is reported to the window.
void act_on_brush(PaintContext& context, JournalEditor& journal, const ActOnBrush& command);
void tend_ink(PaintContext& context, JournalEditor& journal, const TendInk& command);
void fill_model(PaintContext& context, JournalEditor& journal, const FillModel& command);
void change_layers(PaintContext& context, JournalEditor& journal, const ChangeLayers& command);
void change_masks(PaintContext& context, JournalEditor& journal, const ChangeMasks& command);
void change_parts(JournalEditor& journal, const ChangeParts& command);

}  // namespace tuft::app
