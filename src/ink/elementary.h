#pragma once

#include <bit>
#include <cstdint>

/// \file
/// Elementary functions of texels that vectorise and give the same bits on every instruction set, unlike those of the C
/// library. Used by the kernels of `ink`.
namespace tuft::ink {

/// Return the larger and the smaller of two numbers; the second where they are unordered.
[[gnu::always_inline]] inline float larger(float a, float b) {
    return a > b ? a : b;
}
[[gnu::always_inline]] inline float smaller(float a, float b) {
    return a < b ? a : b;
}
/// ⟨a⟩: a where it is positive, else 0.
[[gnu::always_inline]] inline float positive(float a) {
    return a > 0 ? a : 0;
}

/// exp(-x) for x ≥ 0, 1.5e-7 relative: 2^-n by exponent bits, Taylor polynomial on the rest.
inline float exp_minus(float x) {
    const float y = (x < 80.0f ? x : 80.0f) * 1.44269504f;
    const int n = static_cast<int>(y + 0.5f);
    const float f = (static_cast<float>(n) - y) * 0.693147181f;  // |f| ≤ 0.347
    float e = 1.0f / 5040;
    e = e * f + 1.0f / 720;
    e = e * f + 1.0f / 120;
    e = e * f + 1.0f / 24;
    e = e * f + 1.0f / 6;
    e = e * f + 0.5f;
    e = e * f + 1.0f;
    e = e * f + 1.0f;
    return e * std::bit_cast<float>((127 - n) << 23);
}

/// ln(x) for normal x > 0, 4e-8 absolute where |ln x| < 0.35, else relative: exponent bits and
/// the series of artanh on the mantissa in [√½, √2).
inline float log_of(float x) {
    const std::int32_t bits = std::bit_cast<std::int32_t>(x) - 0x3f3504f3;
    const auto e = static_cast<float>(bits >> 23);
    const float m = std::bit_cast<float>((bits & 0x007fffff) + 0x3f3504f3);
    const float s = (m - 1) / (m + 1);
    const float s2 = s * s;
    const float series = 2 * s * (1 + s2 * (0.333333333f + s2 * (0.2f + s2 * (0.142857143f + s2 * 0.111111111f))));
    return e * 0.693147181f + series;
}

}  // namespace tuft::ink
