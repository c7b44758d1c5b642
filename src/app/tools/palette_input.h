#pragma once

#include "app/input/events.h"
#include "app/input/pointer.h"
#include "app/state/colour_state.h"

/// \file
/// Input over the palette. Window thread.
namespace tuft::app {

/// Returns true when the event is over the palette's picture.
bool in_palette(const PaletteState& palette, const Event& e);
/// Returns the aim of an event, straight down on the palette.
Aim palette_aim(const PaletteState& palette, const Event& e);

}  // namespace tuft::app
