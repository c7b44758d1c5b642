#pragma once

#include "app/session/session.h"

/// \file
/// Which dialog is on top. Window thread.
namespace tuft::app {

/// Returns true when a dialog is open, so that the view takes no input.
bool is_dialog_open(const Session& s);
/// Cancels the topmost dialog; without one, ends a comparison or clears the selection. Returns false when there was
/// nothing to close.
bool close_top_dialog(Session& s);
/// Puts away the first shown of the panels over the view that can be shown again: brushes, colour wheel, arm, palette.
/// Returns false when none is shown.
bool close_top_panel(Session& s);

}  // namespace tuft::app
