#include "ink/composite.h"

#include <bit>
#include <cmath>

#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
using Texels = std::array<float, kN>;

/// exp(-x) for x ≥ 0, 1.5e-7 relative: 2^-n by exponent bits, Taylor polynomial on the
/// rest. Written out so that it vectorises and gives the same bits everywhere.
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

TUFT_CLONES void add_scaled(float* __restrict sum, const float* __restrict w, float factor) {
    for (int t = 0; t < kN; ++t) sum[t] += factor * w[t];
}

/// `layer` and `over` of kubelka_munk.h for K X and S X per texel; `k` becomes R.
TUFT_CLONES void film_over(float* __restrict k, const float* __restrict s, float r_substrate) {
    for (int t = 0; t < kN; ++t) {
        const float y2 = k[t] * (k[t] + 2 * s[t]);
        const float y = std::sqrt(y2);
        const float e = exp_minus(y);
        const float e2 = e * e;
        const float series = 1 - y2 * (0.333333333f - y2 * (0.133333333f - y2 * 0.0539682540f));
        const float ratio = (1 - e2) / ((1 + e2) * (y + 1e-30f));
        const float u = y2 < 0.01f ? series : ratio;
        const float inverse = 1 / (1 + (k[t] + s[t]) * u);
        const float r0 = s[t] * u * inverse;
        const float transmitted = 2 * e / (1 + e2) * inverse;
        const float open = 1 - r0 * r_substrate;
        k[t] = r0 + transmitted * transmitted * r_substrate / (open > 1e-7f ? open : 1e-7f);
    }
}

/// The dry film covers the substrate's microfacets within a fraction of a film unit.
TUFT_CLONES void blend_roughness(float* __restrict roughness, const float* __restrict weighted,
                                 const float* __restrict film, float substrate) {
    for (int t = 0; t < kN; ++t) {
        const float covered = 1 - exp_minus(4 * film[t]);
        const float mean = weighted[t] / (film[t] > 1e-12f ? film[t] : 1e-12f);
        roughness[t] = substrate + (mean - substrate) * covered;
    }
}

}  // namespace

static_assert(kBands == 3, "with more bands, look_of_tile has to go from spectrum to RGB");

TileLook look_of_tile(const Canvas& canvas, std::uint32_t slot, const Substrate& substrate) {
    TileLook look;
    alignas(64) std::array<Texels, kBands> s{};
    alignas(64) Texels film{}, rough{};
    for (Texels& k : look.colour) k.fill(0);
    look.height.fill(0);
    const std::vector<Pigment>& pigments = canvas.pigments();
    for (int p = 0; p < static_cast<int>(pigments.size()); ++p) {
        const Plane* w = canvas.plane(slot, p);
        if (!w) continue;
        for (int b = 0; b < kBands; ++b) {
            add_scaled(look.colour[b].data(), w->data(), pigments[p].k[b]);
            add_scaled(s[b].data(), w->data(), pigments[p].s[b]);
        }
        add_scaled(look.height.data(), w->data(), pigments[p].height * 1e6f);
        add_scaled(rough.data(), w->data(), pigments[p].roughness);
        add_scaled(film.data(), w->data(), 1.0f);
    }
    for (int b = 0; b < kBands; ++b)
        film_over(look.colour[b].data(), s[b].data(), substrate.reflectance[b]);
    blend_roughness(look.roughness.data(), rough.data(), film.data(), substrate.roughness);
    return look;
}

}  // namespace tuft::ink
