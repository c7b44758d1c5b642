#pragma once

#include <string_view>

namespace tuft::test {

/// Whether this processor has the instructions of a level of x86-64: "v3" (AVX2) or "v4" (AVX-512). Any other word
/// names what every processor has.
inline bool has_instructions(std::string_view level) {
    if (level == "v3") return __builtin_cpu_supports("avx2");
    if (level == "v4") return __builtin_cpu_supports("avx512vl");
    return true;
}

}  // namespace tuft::test
