#include "ink/spectrum.h"

#include <algorithm>

namespace tuft::ink {

const std::array<Bands, 3>& band_weights() {
    static constexpr std::array<Bands, 3> kWeights{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return kWeights;
}

Rgb rgb_of_bands(const Bands& reflectance) {
    Rgb colour{};
    for (int c = 0; c < 3; ++c)
        for (int b = 0; b < kBands; ++b) colour[c] += band_weights()[c][b] * reflectance[b];
    return colour;
}

Rgb into_gamut(const Rgb& colour) {
    const auto [low, high] = std::minmax_element(colour.begin(), colour.end());
    const float y = 0.212639f * colour[0] + 0.715169f * colour[1] + 0.072192f * colour[2];
    const float grey = std::clamp(y, 0.0f, 1.0f);
    const float part = std::min(*low < 0 ? grey / (grey - *low) : 1.0f,
                                *high > 1 ? (1 - grey) / (*high - grey) : 1.0f);
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = grey + (colour[c] - grey) * part;
    return out;
}

Bands bands_of_rgb(const Rgb& colour) {
    return colour;
}

}  // namespace tuft::ink
