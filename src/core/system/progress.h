#pragma once

#include <functional>
#include <string_view>

#include "core/error.h"

/// \file
/// Progress and cancellation of long work, for `cli` and `app`.
namespace tuft {

/// Called during long work with the name of the phase and its completed fraction in [0, 1]. When it returns false,
/// the worker throws `Cancelled` and leaves no partial result.
using ProgressFn = std::function<bool(std::string_view phase, double fraction)>;

/// Calls `progress` if there is one. Throws `Cancelled` when it returns false.
inline void report(const ProgressFn& progress, std::string_view phase, double fraction) {
    if (progress && !progress(phase, fraction)) throw Cancelled();
}

}  // namespace tuft
