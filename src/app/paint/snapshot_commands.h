#pragma once

#include "app/paint/journal_editor.h"
#include "app/work/commands.h"

/// \file
/// Named states of the journal: taking, showing and restoring them.
namespace tuft::app {

void take_snapshot(PaintContext& context, const TakeSnapshot& command);
void rename_snapshot(PaintContext& context, const RenameSnapshot& command);
/// Paints a snapshot beside the work and hands over its picture.
void show_snapshot(PaintContext& context, const ShowSnapshot& command);
void restore_snapshot(PaintContext& context, JournalEditor& journal, const RestoreSnapshot& command);

}  // namespace tuft::app
