#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"

/// JSON that came from outside.
namespace tuft {

/// Parses `text`. Throws `Error` where brackets nest deeper than `deepest`, whatever the memory
/// would bear, and nlohmann::json::parse_error for what is no JSON.
inline nlohmann::json parse_shallow_json(std::string_view text, int deepest = 16) {
    return nlohmann::json::parse(text.begin(), text.end(), [deepest](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        if (depth > deepest) throw Error("brackets nest too deeply");
        return true;
    });
}

}  // namespace tuft
