#include "ink/deposit.h"

#include <algorithm>
#include <cmath>

#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kLanes = 16;

/// film = the least of film and w / part.
TUFT_CLONES void limit_film(float* __restrict film, const float* __restrict w, float inverse_part) {
    for (int t = 0; t < kN; ++t) {
        const float f = w[t] * inverse_part;
        film[t] = f < film[t] ? f : film[t];
    }
}

TUFT_CLONES void add_film(float* __restrict all, const float* __restrict w) {
    for (int t = 0; t < kN; ++t) all[t] += w[t];
}

/// film becomes dw; returns whether any is positive.
TUFT_CLONES bool increments(float* __restrict film, const float* __restrict all,
                            const float* __restrict coverage, float target, float capacity,
                            float rate) {
    for (int t = 0; t < kN; ++t) {
        const float room = film[t] + capacity - all[t];
        const float goal = target * coverage[t];
        const float limit = goal < room ? goal : room;
        const float lack = limit - film[t];
        film[t] = (lack > 0 ? lack : 0) * rate;
    }
    int wanted = 0;
    for (int t = 0; t < kN; ++t) wanted |= film[t] > 0;
    return wanted != 0;
}

/// w += part · dw; returns Σ (stored change) · area, summed in lanes of fixed order.
TUFT_CLONES double store(float* __restrict w, const float* __restrict dw, float part,
                         const float* __restrict area) {
    double sum[kLanes] = {};
    for (int t = 0; t < kN; t += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const float before = w[t + lane];
            const float after = before + part * dw[t + lane];
            w[t + lane] = after;
            sum[lane] += (static_cast<double>(after) - static_cast<double>(before)) *
                         static_cast<double>(area[t + lane]);
        }
    }
    double total = 0;
    for (const double s : sum) total += s;
    return total;
}

}  // namespace

Mix mix_of(Canvas& canvas, const Ink& ink) {
    Mix mix{};
    for (const InkPart& part : ink.parts)
        mix[canvas.add_pigment(part.pigment)] += static_cast<float>(part.fraction);
    return mix;
}

double deposit(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> coverage,
               std::span<const float, kN> area, double ds, const DepositParams& params) {
    alignas(64) float film[kN];
    alignas(64) float all[kN];
    std::fill(std::begin(film), std::end(film), HUGE_VALF);
    std::fill(std::begin(all), std::end(all), 0.0f);
    double strength = 0;
    for (int p = 0; p < kMaxPigments; ++p) {
        const Plane* w = canvas.plane(slot, p);
        if (w) add_film(all, w->data());
        if (!(params.mix[p] > 0)) continue;
        strength += params.mix[p];
        if (w)
            limit_film(film, w->data(), 1.0f / params.mix[p]);
        else
            std::fill(std::begin(film), std::end(film), 0.0f);
    }
    if (!(strength > 0) || !(params.target > 0) || !(ds > 0)) return 0;
    const auto rate = static_cast<float>(-std::expm1(-ds / params.transfer_length));
    if (!increments(film, all, coverage.data(), params.target, params.capacity, rate)) return 0;
    double given = 0;
    for (int p = 0; p < kMaxPigments; ++p)
        if (params.mix[p] > 0)
            given += store(canvas.touch(slot, p).data(), film, params.mix[p], area.data());
    return given / strength;
}

}  // namespace tuft::ink
