#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// \file
/// Transfer curve of sRGB (IEC 61966-2-1). Used for textures, pictures and the colour panel.
namespace tuft::ink {

/// Linear [0, 1] to encoded [0, 1] and back.
float srgb_encode(float linear);
float srgb_decode(float encoded);

/// Linear light of each 8-bit code.
const std::array<float, 256>& linear_of_code();

/// 8-bit codes of linear light i / 65535.
const std::array<std::uint8_t, 65536>& codes_of_linear();
/// The nearest 8-bit code of linear light, cut to [0, 1]; undoes `linear_of_code`.
inline std::uint8_t code_of_linear(float linear) {
    static const std::array<std::uint8_t, 65536>& codes = codes_of_linear();
    const float c = linear > 0 ? (linear < 1 ? linear : 1) : 0;
    return codes[static_cast<std::size_t>(c * 65535 + 0.5f)];
}

}  // namespace tuft::ink
