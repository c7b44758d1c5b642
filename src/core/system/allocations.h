#pragma once

#include <cstdint>

/// \file
/// Counts the memory allocations of a thread, for tests and programs that prove that a loop makes none. A program that
/// calls this function gets `operator new` of allocations.cpp, which counts and calls `malloc`.
namespace tuft {

/// Calls of `operator new` by the calling thread since it began.
std::uint64_t allocations_of_this_thread();

}  // namespace tuft
