#pragma once

#include <algorithm>
#include <string>

/// \file
/// ASCII letters in lower case, for names that are compared without regard to case.
namespace tuft {

/// Returns the text with A–Z in lower case; other bytes stay.
inline std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

}  // namespace tuft
