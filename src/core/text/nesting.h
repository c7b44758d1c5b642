#pragma once

#include <string>
#include <string_view>

/// \file
/// How deeply a TOML or JSON text may be nested. Their parsers, and the destructors of what they
/// build, call themselves once per level, so a text of a hundred kilobytes can overflow the stack.
/// Callers check a text here before a parser sees it. XML is bounded where its elements are
/// visited.
namespace tuft {

inline constexpr int kDeepestJson = 100;  ///< arrays and objects within each other
inline constexpr int kDeepestToml = 32;   ///< arrays and inline tables within each other, and parts of one key

/// Throws `Error` with `source` and line when arrays and inline tables are within each other more
/// than `kDeepestToml` times, or a dotted key or table header has more parts. A text that is no
/// TOML may pass: the parser stops at its first fault. One pass.
void check_toml_nesting(std::string_view text, const std::string& source);

/// Throws `Error` with `source` when arrays and objects are within each other more than
/// `kDeepestJson` times. One pass.
void check_json_nesting(std::string_view text, const std::string& source);

}  // namespace tuft
