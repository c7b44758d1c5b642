#pragma once

#include "app/input/events.h"
#include "app/input/pointer_input.h"
#include "app/session/colour_state.h"

namespace tuft::app {

bool in_palette(const PaletteState& palette, const Event& e);
/// Where an event points over the plate, seen from straight above.
Aim palette_aim(const PaletteState& palette, const Event& e);

}  // namespace tuft::app
