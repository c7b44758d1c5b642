#pragma once

#include "app/session/session.h"

/// \file
/// What lasts from run to run, in the file `settings` of the state folder: preferences, the pen's curve, which panels
/// and sections are open.
namespace tuft::app {

void load_settings(Session& s);
/// Where it cannot be written, the settings hold for this run.
void store_settings(const Session& s);
/// Folds both panels away, or brings them back when both are, and stores that.
void fold_panels(Session& s);

}  // namespace tuft::app
