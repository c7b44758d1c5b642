#pragma once

#include "cli/arguments.h"

namespace tuft::cli {

/// One function per command. Results go to standard output, notes and progress to
/// standard error. They throw `Error` or `Cancelled`; the return value is the exit status.
int run(const Paint& arguments);
int run(const Inspect& arguments);
int run(const Unwrap& arguments);
int run(const Replay& arguments);
int run(const Export& arguments);
int run(const Render& arguments);
int run(const Brush& arguments);
int run(const BiasCorrection& arguments);
int run(const Bench& arguments);
int run(const LayerWork& arguments);
int run(const FillWork& arguments);
int run(const MaskWork& arguments);
int run(const InkWork& arguments);

}  // namespace tuft::cli
