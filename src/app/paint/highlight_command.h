#pragma once

#include "app/work/command_queue.h"
#include "app/work/paint_context.h"

/// \file
/// Highlighting of journal entries on the model. Paint thread.
namespace tuft::app {

/// Highlights the ink that entries of the journal left on the model. The next command in `queue` interrupts it.
void highlight_strokes(PaintContext& context, const HighlightStrokes& command, const CommandQueue& queue);

}  // namespace tuft::app
