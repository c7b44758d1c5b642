#pragma once

#include <string>
#include <string_view>

/// \file
/// Limits on the nesting of a TOML or JSON text. The parsers and the destructors of their trees recurse once per
/// level, so a text of a hundred kilobytes can overflow the stack. Callers check a text here before they parse it.
/// XML is bounded by the functions that visit its elements.
namespace tuft {

inline constexpr int kDeepestJson = 100;  ///< levels of arrays and objects
inline constexpr int kDeepestToml = 32;   ///< levels of arrays and inline tables, and parts of one key

/// Throws `Error` with `source` and line when arrays and inline tables nest deeper than `kDeepestToml`, or when a
/// dotted key or table header has more parts than that. Malformed TOML may pass: the parser stops at its first
/// fault. Cost: one pass.
void check_toml_nesting(std::string_view text, const std::string& source);

/// Throws `Error` with `source` when arrays and objects nest deeper than `kDeepestJson`. Cost: one pass.
void check_json_nesting(std::string_view text, const std::string& source);

}  // namespace tuft
