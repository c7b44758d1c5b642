#pragma once

#include <cstdint>
#include <span>

/// \file
/// What is fuzzed. Each target takes any bytes and hands them to one parser, or paints with them.
/// It may throw nothing but `tuft::Error`, which it swallows; another exception, a signal or a
/// broken promise (`promise`) is a finding. Targets keep no state but what is made of an input's bytes alone, so that
/// an input by itself shows its finding again.
namespace tuft::fuzz {

struct Target {
    const char* name;  ///< of its corpus and of its program, fuzz_NAME
    void (*run)(std::span<const std::uint8_t>);
    int smoke;  ///< mutations in the normal tests: some seconds
    bool text;  ///< mutations keep to lines and words more often
};

std::span<const Target> targets();

/// The target of that name; nullptr where there is none.
const Target* find_target(const char* name);

}  // namespace tuft::fuzz
