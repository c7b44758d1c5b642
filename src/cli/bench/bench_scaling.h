#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"

/// \file
/// How the speed of `tuft` goes with threads, triangles, texels and the size of the stamp, for the page of `tuft
/// bench`.
namespace tuft::cli {

/// Returns what `measure_threads` does, and three lists of measurements: "triangles", "texels" and "stamp" (one thread,
/// CPU time; medians). Runs for a minute, or some minutes where not quick. Sets the number of threads to one.
nlohmann::json measure_scaling(const Bench& arguments, Console& console);

}  // namespace tuft::cli
