#pragma once

#include "core/manual/manual.h"

namespace CLI {
class App;
}

namespace tuft::cli {

/// The tables that the command line is parsed by, as what manual pages and completions are made
/// from. Commands and options without a group are left out.
Manual manual_of(const CLI::App& app);

/// What `tuft --version` prints: a line, or one JSON object with the libraries' versions and facts
/// of the build.
std::string version_text(bool json);

}  // namespace tuft::cli
