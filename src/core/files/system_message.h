#pragma once

#include <system_error>

#include "core/message.h"

/// \file
/// What the operating system says of a failure, as a message that has a translation.
namespace tuft {

/// Returns the words of `std::strerror` for a value of errno; in English for one that is rare.
Message system_message(int code);
Message system_message(const std::error_code& code);

}  // namespace tuft
