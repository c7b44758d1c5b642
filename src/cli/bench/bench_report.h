#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"

/// \file
/// A page of the figures of `tuft bench`, with plots and the ratio to an earlier one.
namespace tuft::cli {

/// Throws `Error` or `UsageError` where the page cannot be written or the earlier figures cannot be read: before
/// anything is measured. Does nothing without --report.
void check_bench_report(const Bench& arguments);

/// Measures how speed scales, and writes the page (.html, or .md with the plots as .svg beside it) and the numbers
/// (.json beside it). `figures` are those that `tuft bench` prints. Throws `Error` where a file cannot be written.
void write_bench_report(const Bench& arguments, const nlohmann::json& figures, Console& console);

}  // namespace tuft::cli
