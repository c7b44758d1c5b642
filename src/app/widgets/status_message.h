#pragma once

#include <utility>

#include "core/message.h"

/// \file
/// The status bar's message. Window thread.
namespace tuft::app {

/// The line of text in the status bar.
struct StatusMessage {
    Message text;
    double seconds = 0;  ///< since it was set
};

/// Shows a message in place of the one before.
inline void show_message(StatusMessage& status, Message text) {
    status = {std::move(text), 0};
}

}  // namespace tuft::app
