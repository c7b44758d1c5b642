#include "ink/spectra/srgb.h"

#include <cmath>

namespace tuft::ink {

float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

const std::array<float, 256>& linear_of_code() {
    static const auto table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i) t[i] = srgb_decode(static_cast<float>(i) / 255.0f);
        return t;
    }();
    return table;
}

const std::array<std::uint8_t, 65536>& codes_of_linear() {
    static const auto table = [] {
        std::array<std::uint8_t, 65536> t{};
        for (std::size_t i = 0; i < t.size(); ++i)
            t[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_encode(static_cast<float>(i) / 65535.0f)));
        return t;
    }();
    return table;
}

}  // namespace tuft::ink
