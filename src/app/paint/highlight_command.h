#pragma once

#include "app/work/command_queue.h"
#include "app/work/paint_context.h"

namespace tuft::app {

/// Highlights what entries of the journal left on the model. The next command of `queue` ends that.
void highlight_strokes(PaintContext& context, const HighlightStrokes& command, const CommandQueue& queue);

}  // namespace tuft::app
