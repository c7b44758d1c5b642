#pragma once

#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Export from the studio. Paint thread.
namespace tuft::app {

/// Writes the model with its maps, single maps or the strokes, by the path's extension, and pictures beside it. Throws
/// `Error`, `Cancelled`.
void export_model(PaintContext& context, const ExportModel& command);

}  // namespace tuft::app
