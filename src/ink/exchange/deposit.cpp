#include "ink/exchange/deposit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"
#include "ink/exchange/tile_deposit.h"
#include "ink/spectra/colorimetry.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels, kRow = atlas::kTile;

// All on n texels, whole rows.

/// film = the least of film and w / part.
TUFT_CLONES void limit_film(float* __restrict film, const float* __restrict w, float inverse_part, int n) {
    for (int t = 0; t < n; ++t) {
        const float f = w[t] * inverse_part;
        film[t] = f < film[t] ? f : film[t];
    }
}

TUFT_CLONES void add_film(float* __restrict all, const float* __restrict w, int n) {
    for (int t = 0; t < n; ++t) all[t] += w[t];
}

TUFT_CLONES void linear_goals(float* __restrict goal, const float* __restrict coverage, float target, int n) {
    for (int t = 0; t < n; ++t) goal[t] = target * coverage[t];
}

/// goal = −ln(1 − f hidden) / ε.
TUFT_CLONES void goals(float* __restrict goal, const float* __restrict coverage, float hidden, float inverse_extinction,
                       int n) {
    for (int t = 0; t < n; ++t) goal[t] = -log_of(1 - coverage[t] * hidden) * inverse_extinction;
}

/// film becomes dw; returns whether any is positive.
TUFT_CLONES bool increments(float* __restrict film, const float* __restrict all, const float* __restrict goal,
                            float capacity, float rate, int n) {
    for (int t = 0; t < n; ++t) {
        const float free = film[t] + capacity - all[t];
        const float limit = goal[t] < free ? goal[t] : free;
        const float lack = limit - film[t];
        film[t] = (lack > 0 ? lack : 0) * rate;
    }
    int wanted = 0;
    for (int t = 0; t < n; ++t) wanted |= film[t] > 0;
    return wanted != 0;
}

TUFT_CLONES void scale_goals(float* __restrict goal, const float* __restrict tone, int n) {
    for (int t = 0; t < n; ++t) goal[t] *= tone[t];
}

void law_goals(float* goal, const float* coverage, float target, const DepositLaw& law, int n) {
    if (law.hidden > 0)
        goals(goal, coverage, law.hidden, law.inverse_extinction, n);
    else
        linear_goals(goal, coverage, target, n);
}

bool is_bare(const float* row) {
    std::array<std::uint64_t, kRow * sizeof(float) / sizeof(std::uint64_t)> words;
    std::memcpy(words.data(), row, sizeof(words));
    std::uint64_t any = 0;
    for (const std::uint64_t w : words) any |= w;
    return any == 0;
}

bool same_row(const float* a, const float* b) {
    return std::memcmp(a, b, kRow * sizeof(float)) == 0;
}

/// Of an ink that is one pigment, on texels that hold no other.
struct Alone {
    float target, hidden, inverse_extinction, capacity, rate, part;
};

/// The film of such an ink in one pass: goals, increments and what is stored, as `law_goals`,
/// `increments` and `store_change` have them, to the bit. Returns whether any increment is positive. `tone`: of
/// `deposit`.
TUFT_CLONES bool deposit_alone(float* __restrict w, const float* __restrict coverage, const float* __restrict tone,
                               const Alone& law, int n) {
    alignas(64) float goal[kRow];
    const float inverse_part = 1.0f / law.part;
    int any = 0;
    for (int row = 0; row < n; row += kRow) {
        const float* f = coverage + row;
        if (row == 0 || !same_row(f, f - kRow)) {
            if (law.hidden > 0)
                for (int t = 0; t < kRow; ++t) goal[t] = -log_of(1 - f[t] * law.hidden) * law.inverse_extinction;
            else
                for (int t = 0; t < kRow; ++t) goal[t] = law.target * f[t];
        }
        for (int t = 0; t < kRow; ++t) {
            const float before = w[row + t], film = before * inverse_part;
            const float free = film + law.capacity - before;
            const float wants = goal[t] * tone[row + t];
            const float limit = wants < free ? wants : free;
            const float lack = limit - film;
            const float dw = (lack > 0 ? lack : 0) * law.rate;
            any |= dw > 0;
            w[row + t] = before + law.part * dw;
        }
    }
    return any != 0;
}

/// Σ (after − before) · area over a tile, lane by lane.
TUFT_CLONES double change_between(const float* __restrict before, const float* __restrict after,
                                  const float* __restrict area) {
    double sum[kRow] = {};
    for (int row = 0; row < kN; row += kRow)
        for (int t = 0; t < kRow; ++t)
            sum[t] += (static_cast<double>(after[row + t]) - static_cast<double>(before[row + t])) *
                      static_cast<double>(area[row + t]);
    double total = 0;
    for (const double s : sum) total += s;
    return total;
}

/// The pigment of an ink that is one; -1: it is several.
int only_pigment(const Mix& mix) {
    int only = -1;
    for (int p = 0; p < kMaxPigments; ++p) {
        if (!(mix[p] > 0)) continue;
        if (only >= 0) return -1;
        only = p;
    }
    return only;
}

}  // namespace

Mix mix_of(Canvas& canvas, const Ink& ink) {
    Mix mix{};
    for (const InkPart& part : ink.parts) mix[canvas.add_pigment(part.pigment)] += static_cast<float>(part.fraction);
    return mix;
}

float extinction_of(const Ink& ink) {
    constexpr Rgb kLuminance{0.2126f, 0.7152f, 0.0722f};  // Rec. 709
    double sum = 0;
    for (const InkPart& part : ink.parts) {
        const PigmentCurve& curve = part.pigment.curve;
        if (curve.nm.empty() && !curve.k.empty()) {
            for (int c = 0; c < 3; ++c)
                sum += part.fraction * kLuminance[c] * curve.scale * (2 * curve.k[c] + curve.s[c]);
            continue;
        }
        if (curve.k.empty()) {  // made from bands, not from a file
            for (int b = 0; b < kBands; ++b)
                for (int c = 0; c < 3; ++c)
                    sum += part.fraction * kLuminance[c] * band_weights()[c][b] *
                           (2 * part.pigment.k[b] + part.pigment.s[b]);
            continue;
        }
        // Over all wavelengths: what is laid down must not depend on the choice of bands.
        for (int i = 0; i < kWavelengths; ++i) {
            const Coefficients at = coefficients_at(curve, static_cast<float>(wavelength_nm(i)));
            for (int c = 0; c < 3; ++c)
                sum += part.fraction * static_cast<double>(kLuminance[c]) * rgb_matching()[c][i] * (2 * at.k + at.s);
        }
    }
    return static_cast<float>(std::max(sum, 0.0));
}

DepositLaw deposit_law(const DepositParams& params, double ds) {
    DepositLaw law;
    if (ds > 0) law.rate = static_cast<float>(-std::expm1(-ds / params.transfer_length));
    // Below 1e-3 the law is linear to 5e-4, and 1 − f hidden would lose digits.
    if (params.extinction * params.target > 1e-3f) {
        // Beyond ε c = 12 the film hides to 6e-6; more would only lose digits.
        const float extinction = std::min(params.extinction, 12 / params.target);
        law.hidden = -std::expm1(-extinction * params.target);
        law.inverse_extinction = 1 / extinction;
    }
    return law;
}

void film_goals(std::span<float, kN> goal, std::span<const float, kN> coverage, const DepositParams& params) {
    law_goals(goal.data(), coverage.data(), params.target, deposit_law(params, 0), kN);
}

void TileDeposit::add(std::span<const float, kN> coverage, const DepositParams& params, const DepositLaw& law) {
    // Nothing happens in rows without coverage.
    int begin = 0, end = kN;
    while (begin < end && is_bare(&coverage[begin])) begin += kRow;
    while (end > begin && is_bare(&coverage[end - kRow])) end -= kRow;
    if (begin == end) return;
    static constexpr std::array<float, kN> kEven = [] {
        std::array<float, kN> even;
        even.fill(1);
        return even;
    }();
    const float* tone = (tone_.empty() ? std::span<const float>(kEven) : tone_).data() + begin;
    const CoveredRows rows{begin, end, &coverage[begin], tone};
    const auto planes = canvas_.open_planes(slot_);
    const int only = only_pigment(params.mix);
    if (only >= 0 && planes[only] != nullptr && std::count(planes.begin(), planes.end(), nullptr) == kMaxPigments - 1)
        add_alone(only, rows, params, law);
    else
        add_among_others(rows, params, law);
}

void TileDeposit::add_alone(int pigment, const CoveredRows& rows, const DepositParams& params, const DepositLaw& law) {
    if (!(params.target > 0) || !(law.rate > 0)) return;
    Plane& plane = *canvas_.open_planes(slot_)[pigment];
    if (alone_ != pigment || alone_part_ != params.mix[pigment]) {
        sum_alone();
        alone_ = pigment;
        alone_part_ = params.mix[pigment];
        before_ = plane;
    }
    const Alone alone{params.target, law.hidden, law.inverse_extinction, params.capacity, law.rate, alone_part_};
    if (!deposit_alone(plane.data() + rows.begin, rows.coverage, rows.tone, alone, rows.end - rows.begin)) return;
    changed_ = true;
    canvas_.mark_dirty(slot_);
}

void TileDeposit::sum_alone() {
    if (changed_)
        given_ += change_between(before_.data(), canvas_.open_planes(slot_)[alone_]->data(), area_.data()) /
                  static_cast<double>(alone_part_);
    changed_ = false;
    alone_ = -1;
}

double TileDeposit::finish() {
    sum_alone();
    return given_;
}

void TileDeposit::add_among_others(const CoveredRows& rows, const DepositParams& params, const DepositLaw& law) {
    const auto [begin, end, coverage, tone] = rows;
    sum_alone();
    const int n = end - begin;
    const auto planes = canvas_.open_planes(slot_);
    alignas(64) float film[kN];
    alignas(64) float all[kN];
    std::fill_n(film, n, HUGE_VALF);
    std::fill_n(all, n, 0.0f);
    double strength = 0;
    for (int p = 0; p < kMaxPigments; ++p) {
        const Plane* w = planes[p];
        if (w) add_film(all, w->data() + begin, n);
        if (!(params.mix[p] > 0)) continue;
        strength += params.mix[p];
        if (w)
            limit_film(film, w->data() + begin, 1.0f / params.mix[p], n);
        else
            std::fill_n(film, n, 0.0f);
    }
    if (!(strength > 0) || !(params.target > 0) || !(law.rate > 0)) return;
    alignas(64) float goal[kN];
    law_goals(goal, coverage, params.target, law, n);
    if (!tone_.empty()) scale_goals(goal, tone, n);
    if (!increments(film, all, goal, params.capacity, law.rate, n)) return;
    double stored = 0;
    for (int p = 0; p < kMaxPigments; ++p)
        if (params.mix[p] > 0)
            stored += store_change(canvas_.touch(slot_, p).data() + begin, film, params.mix[p], &area_[begin], n);
    given_ += stored / strength;
}

double deposit(Canvas& canvas, const CoveredTile& tile, const DepositParams& params, const DepositLaw& law,
               std::span<const float> tone) {
    TileDeposit on_tile(canvas, tile.slot, tile.area, tone);
    on_tile.add(tile.coverage, params, law);
    return on_tile.finish();
}

}  // namespace tuft::ink
