#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// \file
/// Texts from files: their encoding, and their form in messages. Used by readers and by `cli`.
namespace tuft {

/// Returns true when `text` is well-formed UTF-8: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// Returns `text` where it is UTF-8. Otherwise decodes each byte as ISO 8859-1, in which older programs write
/// names.
std::string to_utf8(std::string_view text);

/// Returns the characters of a text, which is decoded as by `to_utf8`.
std::u32string utf32_of(std::string_view text);
/// Returns a character as UTF-8.
std::string utf8_of(char32_t code);

/// Returns `text` for use in a message: UTF-8, with control characters as '?'. A text longer than `most` bytes is
/// cut and ends in "...".
std::string excerpt(std::string_view text, std::size_t most = 60);

}  // namespace tuft
