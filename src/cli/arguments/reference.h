#pragma once

#include "core/manual/manual.h"

namespace CLI {
class App;
}

/// \file
/// The command line's own description, for manual pages, completions and `--version`. Called by arguments.cpp.
namespace tuft::cli {

/// Returns commands and options of the parser for manual pages and completions. Those without a group are left out.
Manual manual_of(const CLI::App& app);

/// Returns the output of `tuft --version`: one line, or one JSON object with versions of libraries and build facts.
std::string version_text(bool json);

}  // namespace tuft::cli
