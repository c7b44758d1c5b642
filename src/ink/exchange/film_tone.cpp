#include "ink/exchange/film_tone.h"

#include <algorithm>
#include <cstdint>

#include "core/simd.h"

namespace tuft::ink {
namespace {

constexpr double kFilmUnit = 10e-6;                    // metres of wet ink
constexpr double kDeepest = 0.35, kLeastShare = 0.03;  // share on grain far higher than the film; seen at least

TUFT_CLONES void multiply_profile(float* __restrict tone, const float* __restrict film, const atlas::TexelShape& shape,
                                  const Vec3f& origin, const Vec3f& across) {
    const float* __restrict x = shape.px.data(), * __restrict y = shape.py.data(), * __restrict z = shape.pz.data();
    constexpr auto last = static_cast<float>(kToneSamples - 1);
    // In three loops, so that what is computed goes in vectors though the samples are read one by one.
    alignas(64) std::int32_t sample[atlas::kTileTexels];
    alignas(64) float part[atlas::kTileTexels], before[atlas::kTileTexels], after[atlas::kTileTexels];
    const float ox = origin.x, oy = origin.y, oz = origin.z, ax = across.x, ay = across.y, az = across.z;
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const float at = (x[t] - ox) * ax + (y[t] - oy) * ay + (z[t] - oz) * az;
        const float low = at > 0 ? at : 0, limited = low < last ? low : last;
        int i = static_cast<int>(limited);
        i = i < kToneSamples - 2 ? i : kToneSamples - 2;
        sample[t] = i;
        part[t] = limited - static_cast<float>(i);
    }
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        before[t] = film[sample[t]];
        after[t] = film[sample[t] + 1];
    }
    for (int t = 0; t < atlas::kTileTexels; ++t) tone[t] *= before[t] + part[t] * (after[t] - before[t]);
}

TUFT_CLONES void multiply_grain(float* __restrict tone, const float* __restrict relief, float share) {
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const float film = 1 + share * relief[t];
        tone[t] *= film > 0 ? film : 0;
    }
}

}  // namespace

void apply_profile(std::span<float, atlas::kTileTexels> tone, const FilmTone& profile, const atlas::TexelShape& shape) {
    if (!profile.even)
        multiply_profile(tone.data(), profile.film.data(), shape, Vec3f(profile.origin), Vec3f(profile.across));
}

void apply_grain(std::span<float, atlas::kTileTexels> tone, std::span<const float, atlas::kTileTexels> relief,
                 float share) {
    if (share > 0) multiply_grain(tone.data(), relief.data(), share);
}

float grain_share(double relief, double film) {
    const double share = relief > 0 ? kDeepest * relief / (relief + kFilmUnit * std::max(film, 0.0)) : 0;
    return share < kLeastShare ? 0.0f : static_cast<float>(share);
}

}  // namespace tuft::ink
