#pragma once

#include <string>

#include "app/session/session.h"

namespace tuft::app {

/// Changes a setting by its name in scripts. Throws `Error` for a name or value that is unknown.
void set_by_name(Session& s, const std::string& name, const std::string& value);
/// The number that a value begins with, 0 where it is a word. Throws `Error` for one that is not within a million.
double number_of(const std::string& value);

}  // namespace tuft::app
