#pragma once

#include "cli/arguments/arguments.h"

namespace CLI {
class App;
}

/// \file
/// Options of `tuft paint` for coloured drawings and copies. Called by `parse_arguments`.
namespace tuft::cli {

/// Adds the options to the command; they fill `paint`, which must outlive it.
void add_drawing_options(CLI::App& command, Paint& paint);

}  // namespace tuft::cli
