#pragma once

#include <cstdint>
#include <ctime>

/// \file
/// Clocks of the system. Called by the loop of an arm, which sleeps until a time of the monotonic one, and by
/// measurements.
namespace tuft {

/// Returns nanoseconds on a clock of `clock_gettime`: by default the monotonic one, which no change of the date moves.
inline std::int64_t clock_ns(clockid_t clock = CLOCK_MONOTONIC) {
    timespec t{};
    ::clock_gettime(clock, &t);
    return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

/// Returns seconds on it.
inline double clock_seconds(clockid_t clock = CLOCK_MONOTONIC) {
    return 1e-9 * static_cast<double>(clock_ns(clock));
}

}  // namespace tuft
