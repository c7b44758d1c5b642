#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// \file
/// Counts with their noun, for messages of `cli`.
namespace tuft {

/// Returns a number with its noun: "1 chart", "3 charts". The plural takes an s.
inline std::string counted(std::size_t n, std::string_view noun) {
    return std::to_string(n) + " " + std::string(noun) + (n == 1 ? "" : "s");
}

}  // namespace tuft
