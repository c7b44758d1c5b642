#pragma once

#include "app/work/commands.h"
#include "app/work/paint_context.h"

/// \file
/// Inks of the work's own, and how the work is shown. None of these paints.
namespace tuft::app {

/// Makes an ink part of the work, under a name that is free.
void add_ink(PaintContext& context, ink::Ink ink);
void pick_ink(PaintContext& context, const PickInk& command);
void recolour(PaintContext& context, const RecolourInk& command);
void preview_substrate(PaintContext& context, const PreviewSubstrate& command);
void show_mask(PaintContext& context, const ShowMask& command);

}  // namespace tuft::app
