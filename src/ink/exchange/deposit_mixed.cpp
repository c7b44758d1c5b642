#include "ink/exchange/deposit_mixed.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kSums = 16;
constexpr int kWater = kMaxPigments;
constexpr double kMostGiven = 0.8;  // of a pigment in one stamp: areas on the surface may exceed the patch's

using Texels = std::array<float, kN>;

/// out = ⟨mix · goal − w⟩ · rate, and its sum over the pigments.
TUFT_CLONES void increments(float* __restrict out, float* __restrict sum, const float* __restrict mix,
                            const float* __restrict goal, const float* __restrict w, float rate) {
    for (int t = 0; t < kN; ++t) {
        out[t] = positive(mix[t] * goal[t] - w[t]) * rate;
        sum[t] += out[t];
    }
}

/// part = how much of the increments there is free for.
TUFT_CLONES void fit_capacity(float* __restrict part, const float* __restrict sum, const float* __restrict all,
                              float capacity) {
    for (int t = 0; t < kN; ++t) {
        const float free = positive(capacity - all[t]);
        part[t] = sum[t] > free ? free / sum[t] : 1;
    }
}

/// Stores the increments; film becomes what they are of the ink under the tuft. Returns Σ stored · area.
TUFT_CLONES double store(float* __restrict w, float* __restrict film, const float* __restrict dw,
                         const float* __restrict part, const float* __restrict mix, const float* __restrict area) {
    double sums[kSums] = {};
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) {
            const float before = w[t + i], d = dw[t + i] * part[t + i];
            const float after = before + d;
            w[t + i] = after;
            film[t + i] = mix[t + i] > 0 ? d / mix[t + i] : 0;
            sums[i] += (static_cast<double>(after) - static_cast<double>(before)) * static_cast<double>(area[t + i]);
        }
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
}

}  // namespace

NodeMixes mixes_within(const Reservoir& tuft, const NodeContact& nodes, double target, double area) {
    NodeMixes mixes = mixes_at(tuft, nodes);
    for (int p = 0; p < kMaxPigments; ++p) {
        const double most = static_cast<double>(*std::max_element(mixes[p].begin(), mixes[p].end()));
        const double requested = most * target * area, limit = kMostGiven * tuft.pigment(p);
        if (!(requested > limit)) continue;
        for (int node = 0; node < kNodes; ++node) {
            const float less = mixes[p][node] * static_cast<float>(1 - limit / requested);
            mixes[p][node] -= less;
            mixes[kWater][node] += less;
        }
    }
    return mixes;
}

void deposit_mixed(Canvas& canvas, const StampedTile& tile, const HatBasis& hats, const DepositParams& params,
                   const NodeMixes& mixes, NodeContents& given) {
    const auto& [covered, ds] = tile;
    const auto& [slot, coverage, area] = covered;
    if (hats.count == 0 || !(params.target > 0) || !(ds > 0)) return;
    alignas(64) Texels goal, all{}, sum{}, part, film;
    alignas(64) std::array<Texels, kMaxPigments> mix, dw;
    film_goals(goal, coverage, params);
    const auto rate = static_cast<float>(-std::expm1(-ds / static_cast<double>(params.transfer_length)));
    std::array<bool, kMaxPigments> used{};
    for (int p = 0; p < kMaxPigments; ++p) {
        const Plane* w = canvas.plane(slot, p);
        if (w) add_plane(all.data(), w->data());
        for (int k = 0; k < hats.count; ++k) used[p] = used[p] || mixes[p][hats.node[k]] > 0;
        if (!used[p]) continue;
        interpolate(mix[p], hats, mixes[p]);
        static constexpr Texels kNone{};
        increments(dw[p].data(), sum.data(), mix[p].data(), goal.data(), w ? w->data() : kNone.data(), rate);
    }
    if (std::none_of(sum.begin(), sum.end(), [](float v) { return v > 0; })) return;
    fit_capacity(part.data(), sum.data(), all.data(), params.capacity);
    std::array<double, kNodes> shares;
    MixtureGiven mixture(given, mixes, hats);
    for (int p = 0; p < kMaxPigments; ++p) {
        if (!used[p]) continue;
        const double stored =
            store(canvas.touch(slot, p).data(), film.data(), dw[p].data(), part.data(), mix[p].data(), area.data());
        integrate_hats(shares, hats, film.data(), area);
        for (int k = 0; k < hats.count; ++k) shares[k] *= static_cast<double>(mixes[p][hats.node[k]]);
        mixture.pigment(p, stored, shares);
    }
    mixture.water();
}

}  // namespace tuft::ink
