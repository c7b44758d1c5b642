#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tuft {

/// "1 chart", "3 charts": a number with its noun, which takes an s.
inline std::string counted(std::size_t n, std::string_view noun) {
    return std::to_string(n) + " " + std::string(noun) + (n == 1 ? "" : "s");
}

}  // namespace tuft
