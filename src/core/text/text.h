#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// \file
/// Texts from files: their encoding, and how they are shown in messages.
namespace tuft {

/// Whether `text` is well-formed UTF-8 (no overlong forms, no surrogates, nothing above U+10FFFF).
bool is_utf8(std::string_view text);

/// `text` itself where it is UTF-8; else each of its bytes is taken for a character of ISO 8859-1,
/// as older programs write names.
std::string to_utf8(std::string_view text);

/// `text` as part of a message: UTF-8, control characters as '?', and what exceeds `most` bytes as
/// "...".
std::string excerpt(std::string_view text, std::size_t most = 60);

}  // namespace tuft
