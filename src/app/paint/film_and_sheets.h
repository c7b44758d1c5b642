#pragma once

#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Decal sheets and films from the studio. Paint thread.
namespace tuft::app {

/// Writes sheets of film at true size. Throws `Error`, `Cancelled`.
void export_sheets(PaintContext& context, ExportSheets command);

/// Films the journal on a document of its own; the work stays as it is. Throws `Error`, `Cancelled`; neither leaves a
/// file.
void export_film(PaintContext& context, ExportFilm command);

}  // namespace tuft::app
