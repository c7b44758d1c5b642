#pragma once

#include <string_view>

#include "core/message.h"

/// \file
/// What a library says of a fault, as a message that has a translation. Libraries say it in English only.
namespace tuft {

/// Returns the kind of the fault: it ends too early, the disk is full, and so on. The library's words follow in
/// parentheses, on one line and shortened, where they say more than the kind does.
Message library_fault(std::string_view words);

/// The same for the description of an error in a TOML text.
Message toml_fault(std::string_view words);

}  // namespace tuft
