#include "ink/exchange/erase.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"
#include "ink/exchange/deposit.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kLanes = 16;
constexpr float kNothing = 1e-6f;  // film units

/// Planes that erasing reads, [256]; see `EraseStart`.
struct ErasedPlanes {
    const float* film;      ///< film units, now
    const float* start;     ///< film units, at the start
    const float* hides;     ///< opacity at the start
    const float* coverage;  ///< 0–1, of the eraser
    const float* liquid;    ///< film units
};

/// Computes the remaining fraction of each texel's film.
TUFT_CLONES void remaining_fraction(float* __restrict factor, const ErasedPlanes& in, float rate) {
    const float* __restrict film = in.film, * __restrict start = in.start, * __restrict hides = in.hides;
    const float* __restrict coverage = in.coverage, * __restrict liquid = in.liquid;
    for (int t = 0; t < kN; ++t) {
        const float f = coverage[t], e = hides[t];
        const float sum = f + exp_minus(e), x = sum < 1 ? sum : 1;
        const float goal = -log_of(x > 1e-30f ? x : 1e-30f) / (e > 1e-3f ? e : 1e-3f);
        const float left = start[t] > film[t] ? film[t] / start[t] : 1;
        const float more = left - goal;
        const float after = left - (more > 0 ? more : 0) * (liquid[t] > 0 ? 1 : rate);
        const float part = left > 0 ? after / left : 0;
        const float stays = film[t] * part < kNothing ? 0 : part;
        factor[t] = f > 0 ? stays : 1;
    }
}

/// w *= factor; returns Σ (change) · area, summed in lanes of fixed order.
TUFT_CLONES double scale(float* __restrict w, const float* __restrict factor, const float* __restrict area) {
    double sum[kLanes] = {};
    for (int t = 0; t < kN; t += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const float before = w[t + lane], after = before * factor[t + lane];
            w[t + lane] = after;
            sum[lane] +=
                (static_cast<double>(before) - static_cast<double>(after)) * static_cast<double>(area[t + lane]);
        }
    }
    double total = 0;
    for (const double s : sum) total += s;
    return total;
}

float extinction_of(const Pigment& pigment) {
    return ink::extinction_of(Ink{.parts = {{pigment, 1.0}}});
}

/// Multiplies all films and liquids of a tile by `factor`.
Amounts scale_all(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> area,
                  const std::array<float, kN>& factor) {
    Amounts gone;
    if (std::all_of(factor.begin(), factor.end(), [](float f) { return f == 1; })) return gone;
    for (int film_place = 0; film_place < kFilms; ++film_place)
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
            if (canvas.film_plane(slot, film_place, p))
                gone.pigment[p] += scale(canvas.touch_film(slot, film_place, p).data(), factor.data(), area.data());
    for (const Liquid where : {Liquid::film, Liquid::pores})
        if (canvas.liquid(slot, where))
            gone.liquid += scale(canvas.touch_liquid(slot, where).data(), factor.data(), area.data());
    return gone;
}

}  // namespace

double Amounts::sum() const {
    double total = 0;
    for (const double p : pigment) total += p;
    return total;
}

Amounts& Amounts::operator+=(const Amounts& other) {
    for (int p = 0; p < kMaxPigments; ++p) pigment[p] += other.pigment[p];
    liquid += other.liquid;
    return *this;
}

EraseStart erase_start(const Canvas& canvas, std::uint32_t slot) {
    EraseStart start;
    start.film.fill(0);
    start.hides.fill(0);
    for (int film = 0; film < kFilms; ++film)
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
            if (const Plane* w = canvas.film_plane(slot, film, p)) {
                add_scaled_plane(start.film.data(), w->data(), 1);
                add_scaled_plane(start.hides.data(), w->data(), extinction_of(canvas.pigments()[p]));
            }
    for (const Liquid where : {Liquid::film, Liquid::pores})
        if (const Plane* w = canvas.liquid(slot, where)) add_scaled_plane(start.film.data(), w->data(), 1);
    return start;
}

Amounts erase(Canvas& canvas, const StampedTile& tile, const EraseStart& start, const EraseParams& params) {
    const auto& [covered, ds] = tile;
    const auto& [slot, coverage, area] = covered;
    Amounts gone;
    if (!canvas.touched(slot) || !(ds > 0) || !(params.strength > 0)) return gone;
    const Plane film = erase_start(canvas, slot).film;
    alignas(64) std::array<float, kN> factor, liquid{};
    for (const Liquid where : {Liquid::film, Liquid::pores})
        if (const Plane* w = canvas.liquid(slot, where)) add_scaled_plane(liquid.data(), w->data(), 1);
    const auto rate = static_cast<float>(-std::expm1(-params.strength * ds / params.transfer_length));
    remaining_fraction(factor.data(),
                       {film.data(), start.film.data(), start.hides.data(), coverage.data(), liquid.data()}, rate);
    return scale_all(canvas, slot, area, factor);
}

Amounts take_part(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> area,
                  std::span<const float, kN> part) {
    if (!canvas.touched(slot)) return {};
    const Plane film = erase_start(canvas, slot).film;
    alignas(64) std::array<float, kN> factor;
    for (int t = 0; t < kN; ++t) {
        factor[t] = std::clamp(1 - part[t], 0.0f, 1.0f);
        if (part[t] > 0 && film[t] * factor[t] < kNothing) factor[t] = 0;
    }
    return scale_all(canvas, slot, area, factor);
}

Amounts add_coat(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> area, const Coat& coat,
                 float capacity) {
    Amounts added;
    alignas(64) std::array<float, kN> all{}, dw, part;
    for (int p = 0; p < kMaxPigments; ++p)
        if (const Plane* w = canvas.plane(slot, p)) add_scaled_plane(all.data(), w->data(), 1);
    float strength[2] = {0, 0};
    for (int p = 0; p < kMaxPigments; ++p) strength[0] += coat.first[p], strength[1] += coat.second[p];
    for (int t = 0; t < kN; ++t) {
        const float wanted = coat.film[t] * (strength[0] + coat.towards[t] * (strength[1] - strength[0]));
        const float left = capacity > all[t] ? capacity - all[t] : 0;
        part[t] = wanted > left ? left / wanted : 1;
    }
    for (int p = 0; p < kMaxPigments; ++p) {
        if (!(coat.first[p] > 0 || coat.second[p] > 0)) continue;
        bool any = false;
        for (int t = 0; t < kN; ++t) {
            dw[t] = part[t] * coat.film[t] * (coat.first[p] + coat.towards[t] * (coat.second[p] - coat.first[p]));
            any = any || dw[t] > 0;
        }
        if (any) added.pigment[p] += store_change(canvas.touch(slot, p).data(), dw.data(), 1, area.data());
    }
    return added;
}

}  // namespace tuft::ink
