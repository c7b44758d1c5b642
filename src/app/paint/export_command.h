#pragma once

#include "app/work/commands.h"
#include "app/work/paint_context.h"

namespace tuft::app {

/// Writes the model with its maps, maps alone, or the strokes, as the path says; and pictures beside it.
void export_model(PaintContext& context, const ExportModel& command);

}  // namespace tuft::app
