#pragma once

#include <functional>
#include <string_view>

#include "core/error.h"

namespace tuft {

/// Called during long work with the name of the phase and the part of it that is
/// done, in [0, 1]. Returning false asks for the work to stop; the worker then
/// throws `Cancelled` and leaves nothing half-done behind.
using ProgressFn = std::function<bool(std::string_view phase, double fraction)>;

/// Reports, if anybody listens; throws `Cancelled` when asked to stop.
inline void report(const ProgressFn& progress, std::string_view phase, double fraction) {
    if (progress && !progress(phase, fraction)) throw Cancelled();
}

}  // namespace tuft
