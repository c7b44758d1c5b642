#pragma once

#include <utility>

#include "core/message.h"

namespace tuft::app {

/// The line of text in the status bar.
struct StatusMessage {
    Message text;
    double seconds = 0;  ///< since it came
};

inline void show_message(StatusMessage& status, Message text) {
    status = {std::move(text), 0};
}

}  // namespace tuft::app
