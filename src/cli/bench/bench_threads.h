#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"

/// \file
/// How the speed of `tuft` goes with the number of threads, for `tuft bench --scaling` and the page of `tuft bench`.
namespace tuft::cli {

/// Measures for every number of threads of `arguments.scaling`, by turns: painting and replay of 40 strokes; painting
/// of 400 shorter ones; wet strokes; the delay of the ink behind a hand; a step of the film of a whole atlas; preparing
/// a model of a million triangles (quick: 100,000). Without numbers they are 1, 2, 4 … and the number of cores. Rounds
/// are repeated, five at most, while `arguments.seconds` probably suffice.
///
/// Returns "threads": a row for each number of threads, with the median of the wall time and of the CPU time of all
/// threads, and "rounds": the number of rounds. Sets the number of threads to one.
nlohmann::json measure_threads(const Bench& arguments, Console& console);

/// Prints those rows: seconds, and how many times as fast as with the first number of threads.
void print_threads(const nlohmann::json& measured);

}  // namespace tuft::cli
