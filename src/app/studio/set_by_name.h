#pragma once

#include <string>

#include "app/session/session.h"

/// \file
/// Settings by name, for scripts. Window thread.
namespace tuft::app {

/// Changes a setting. Throws `Error` for an unknown name or value.
void set_by_name(Session& s, const std::string& name, const std::string& value);
/// Returns the number at the start of a value, 0 for a word. Throws `Error` for one beyond ±10⁶.
double number_of(const std::string& value);

}  // namespace tuft::app
