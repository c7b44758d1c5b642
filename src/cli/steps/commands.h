#pragma once

#include "cli/arguments/arguments.h"

/// \file
/// The commands of `tuft`. Called by main.cpp on the main thread.
namespace tuft::cli {

/// Runs one command and returns the exit status. Results go to standard output, notes and progress to standard error.
/// Throws `Error` or `Cancelled`.
int run(const Paint& arguments);
int run(const Write& arguments);
int run(const Inspect& arguments);
int run(const Unwrap& arguments);
int run(const Decimate& arguments);
int run(const Replay& arguments);
int run(const Export& arguments);
int run(const Render& arguments);
int run(const Film& arguments);
int run(const Brush& arguments);
int run(const BiasCorrection& arguments);
int run(const Bench& arguments);
int run(const LayerWork& arguments);
int run(const PartWork& arguments);
int run(const FillWork& arguments);
int run(const MaskWork& arguments);
int run(const InkWork& arguments);
int run(const DeviceWork& arguments);
int run(const Decals& arguments);
int run(const TrajectoryWork& arguments);
int run(const VariantsWork& arguments);
int run(const RunTask& arguments);

}  // namespace tuft::cli
