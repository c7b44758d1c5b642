#pragma once

#include "app/session/session.h"

/// \file
/// Settings that last between runs, in the file `settings` of the state folder: preferences, the pen curve, open panels
/// and sections. Window thread.
namespace tuft::app {

/// Reads the settings of the last session. A key that is unknown is ignored, a value out of range becomes the nearest
/// one.
void load_settings(Session& s);
/// Writes the file. A failure is ignored: the settings then hold for this run.
void store_settings(const Session& s);
/// Hides both panels, or shows them when both are hidden, and stores that.
void fold_panels(Session& s);

}  // namespace tuft::app
