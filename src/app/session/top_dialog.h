#pragma once

#include "app/session/session.h"

namespace tuft::app {

/// A dialog is open: what lies behind it takes no input.
bool is_dialog_open(const Session& s);
/// Closes the dialog that lies on top, as its Cancel does; without one, ends a comparison or drops what is selected.
/// False when there is nothing of that.
bool close_top_dialog(Session& s);

}  // namespace tuft::app
