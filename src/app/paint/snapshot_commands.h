#pragma once

#include "app/paint/journal_editor.h"
#include "app/work/commands.h"

/// \file
/// Commands that take, show and restore snapshots of the journal. Paint thread.
namespace tuft::app {

/// Stores a snapshot of the journal as it is, and changes the name of one.
void take_snapshot(PaintContext& context, const TakeSnapshot& command);
void rename_snapshot(PaintContext& context, const RenameSnapshot& command);
/// Paints a snapshot on a second document and passes its texels to the window.
void show_snapshot(PaintContext& context, const ShowSnapshot& command);
void restore_snapshot(PaintContext& context, JournalEditor& journal, const RestoreSnapshot& command);

}  // namespace tuft::app
