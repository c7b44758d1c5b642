#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

/// \file
/// A TOML text as a table: the one entrance to the parser. Callers link `tomlplusplus` themselves.
namespace tuft {

/// Returns the table of `text`. `source` names the text in errors. Throws `Error` with `source` and line where it is no
/// TOML, or nests deeper than `kDeepestToml` (core/text/nesting.h). Cost: two passes.
toml::table parse_toml(std::string_view text, const std::string& source);

}  // namespace tuft
