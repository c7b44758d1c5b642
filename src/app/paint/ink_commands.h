#pragma once

#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Commands for inks and for how the work is shown. None of them paints. Paint thread.
namespace tuft::app {

/// Adds an ink to the project, renamed where its name is taken.
void add_ink(PaintContext& context, ink::Ink ink);
void pick_ink(PaintContext& context, const PickInk& command);
void recolour(PaintContext& context, const RecolourInk& command);
void preview_substrate(PaintContext& context, const PreviewSubstrate& command);
void show_mask(PaintContext& context, const ShowMask& command);

}  // namespace tuft::app
