#include "ink/transfer.h"

#include <algorithm>
#include <cmath>

#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kSums = 16;
constexpr int kWater = kMaxPigments;
constexpr double kSkinFilm = 4;         // film units on full hair
constexpr double kHalfFull = 0.5;       // saturation from which hair is wet outside all over
constexpr double kSkinTime = 0.3;       // seconds
constexpr double kExchangeLength = 4e-3, kExchangeTime = 0.5;  // metres, seconds
constexpr double kGentle = 0.3;         // of the exchange under firm pressure
constexpr double kMostGiven = 0.999;    // of the skin: rounding may not take more than there is

using Texels = std::array<float, kN>;

double sum_of(const Reservoir::Content& c) {
    double sum = 0;
    for (const double v : c) sum += v;
    return sum;
}

inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float positive(float a) { return a > 0 ? a : 0; }

void by_lane(Texels& out, std::span<const std::uint8_t, kN> lanes, const std::array<float, kLanes>& values) {
    for (int t = 0; t < kN; ++t) out[t] = values[lanes[t]];
}

struct Volumes {
    alignas(64) Texels down, up;
};

TUFT_CLONES void volumes(Volumes& out, const float* __restrict coverage, const float* __restrict goal,
                         const float* __restrict w, const float* __restrict total,
                         const float* __restrict film, const float* __restrict room, float target,
                         float capacity, float rate, float exchange, float thirst) {
    for (int t = 0; t < kN; ++t) {
        const float touched = coverage[t] > 0 ? 1.0f : 0.0f;
        const float lack = positive(smaller(goal[t] - w[t], capacity - total[t])) * rate;
        const float n = smaller(lack, film[t] * touched);
        const float part = coverage[t] * exchange;
        const float x = part * smaller(w[t], film[t] - n);
        const float over = positive(w[t] - larger(goal[t], target)) * part * thirst;
        const float lift = smaller(over, smaller(room[t], w[t] - x));
        out.down[t] = n + x;
        out.up[t] = x + lift;
    }
}

TUFT_CLONES void add_concentration(float* __restrict sum, const float* __restrict p, const float* __restrict total) {
    for (int t = 0; t < kN; ++t) sum[t] += total[t] > 0 ? p[t] / total[t] : 0;
}

/// up becomes the part of the open film's pigments that goes with the liquid.
TUFT_CLONES void lifted_part(float* __restrict up, const float* __restrict total, const float* __restrict dense) {
    for (int t = 0; t < kN; ++t) {
        const float most = dense[t] > 1 ? 1 / dense[t] : 1;
        up[t] = total[t] > 0 ? up[t] / total[t] * most : 0;
    }
}

TUFT_CLONES void move(float* __restrict p, const float* __restrict down, const float* __restrict mix,
                      const float* __restrict part, float* __restrict before) {
    for (int t = 0; t < kN; ++t) {
        before[t] = p[t];
        p[t] = (p[t] - p[t] * part[t]) + down[t] * mix[t];
    }
}

/// Σ (after − before) · area over the texels of a lane, in an order of its own.
TUFT_CLONES double change(const float* __restrict after, const float* __restrict before,
                          const float* __restrict area, const std::uint8_t* __restrict lanes, int lane) {
    double sums[kSums] = {};
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) {
            const double d = (static_cast<double>(after[t + i]) - static_cast<double>(before[t + i])) *
                             static_cast<double>(area[t + i]);
            sums[i] += lanes[t + i] == lane ? d : 0.0;
        }
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
}

}  // namespace

double Skin::volume(int lane) const { return sum_of(content[lane]); }

void withdraw(Skin& skin, Reservoir& tuft, const Touch& touch) {
    Reservoir::Content all{};
    for (Reservoir::Content& lane : skin.content) {
        for (int p = 0; p < Reservoir::kPlanes; ++p) all[p] += lane[p];
        lane.fill(0);
    }
    absorb(tuft, all, touch);
}

void refresh(Skin& skin, Reservoir& tuft, const Touch& touch, const LaneAreas& areas, double dt) {
    const double wet = std::min(1.0, saturation_at(tuft, touch) / kHalfFull);
    const double part = -std::expm1(-std::max(dt, 0.0) / kSkinTime);
    std::array<double, kLanes> want;
    Reservoir::Content back{};
    for (int lane = 0; lane < kLanes; ++lane) {
        want[lane] = kSkinFilm * wet * areas[lane];
        const double volume = skin.volume(lane);
        if (!(volume > 0)) continue;
        // Where the hair has left the surface, what was on it spreads among the rest.
        const double leaves = std::max(part, 1 - std::min(1.0, 1.25 * want[lane] / volume));
        for (int p = 0; p < Reservoir::kPlanes; ++p) {
            const double v = leaves * skin.content[lane][p];
            skin.content[lane][p] -= v;
            back[p] += v;
        }
    }
    absorb(tuft, back, touch);
    double lack = 0;
    for (int lane = 0; lane < kLanes; ++lane) lack += std::max(0.0, want[lane] - skin.volume(lane));
    if (!(lack > 0)) return;
    const Reservoir::Content fresh = take(tuft, std::min(lack, tuft.remaining()), touch);
    std::array<double, kLanes> share;
    for (int lane = 0; lane < kLanes; ++lane)
        share[lane] = std::max(0.0, want[lane] - skin.volume(lane)) / lack;
    for (int lane = 0; lane < kLanes; ++lane)
        for (int p = 0; p < Reservoir::kPlanes; ++p) skin.content[lane][p] += share[lane] * fresh[p];
}

TransferParams transfer_params(const Skin& skin, const Reservoir& tuft, const Touch& touch,
                               const LaneAreas& areas, const DepositParams& deposit, double ds,
                               double dt, double stress) {
    TransferParams out;
    out.deposit = deposit;
    const double way = ds / kExchangeLength + std::max(dt, 0.0) / kExchangeTime;
    out.exchange = static_cast<float>(-std::expm1(-way * (kGentle + (1 - kGentle) * std::clamp(stress, 0.0, 1.0))));
    out.thirst = static_cast<float>(std::clamp(1 - saturation_at(tuft, touch), 0.0, 1.0));
    double area = 0;
    for (const double a : areas) area += a;
    const double room = area > 0 ? room_left(tuft, touch) / area : 0;
    for (int lane = 0; lane < kLanes; ++lane) {
        const double volume = skin.volume(lane);
        out.room[lane] = static_cast<float>(room);
        if (!(volume > 0) || !(areas[lane] > 0)) continue;
        out.film[lane] = static_cast<float>(kMostGiven * volume / areas[lane]);
        for (int p = 0; p < kMaxPigments; ++p)
            out.mix[lane][p] = static_cast<float>(std::max(0.0, skin.content[lane][p]) / volume);
    }
    return out;
}

void transfer(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> coverage,
              std::span<const std::uint8_t, kN> lanes, std::span<const float, kN> area, double ds,
              const TransferParams& params, LaneContents& given) {
    alignas(64) Texels film, room, goal, total, dense{}, mix, before, held;
    by_lane(film, lanes, params.film);
    by_lane(room, lanes, params.room);
    film_goals(goal, coverage, params.deposit);
    Plane& w = canvas.touch_liquid(slot, Liquid::film);
    const Plane* s = canvas.liquid(slot, Liquid::pores);
    for (int t = 0; t < kN; ++t) total[t] = s ? w[t] + (*s)[t] : w[t];
    Volumes v;
    const auto rate = static_cast<float>(-std::expm1(-ds / static_cast<double>(params.deposit.transfer_length)));
    volumes(v, coverage.data(), goal.data(), w.data(), total.data(), film.data(), room.data(),
            params.deposit.target, params.deposit.capacity, rate, params.exchange, params.thirst);
    held = w;
    for (int t = 0; t < kN; ++t) w[t] = (w[t] - v.up[t]) + v.down[t];
    std::uint32_t present = 0;  // bits: lanes on this tile
    for (int t = 0; t < kN; ++t) present |= coverage[t] > 0 ? 1u << lanes[t] : 0;
    const auto book = [&](const float* after, const float* was, int plane) {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (!(present >> lane & 1)) continue;
            const double d = change(after, was, area.data(), lanes.data(), lane);
            given[lane][plane] += d;
            if (plane != kWater) given[lane][kWater] -= d;  // the liquid counts its pigments
        }
    };
    book(w.data(), held.data(), kWater);
    for (int p = 0; p < kMaxPigments; ++p)
        if (const Plane* here = canvas.plane(slot, p)) add_concentration(dense.data(), here->data(), total.data());
    lifted_part(v.up.data(), total.data(), dense.data());
    for (int p = 0; p < kMaxPigments; ++p) {
        std::array<float, kLanes> parts;
        float most = 0;
        for (int lane = 0; lane < kLanes; ++lane) {
            parts[lane] = params.mix[lane][p];
            most = std::max(most, present >> lane & 1 ? parts[lane] : 0);
        }
        if (!(most > 0) && !canvas.plane(slot, p)) continue;
        by_lane(mix, lanes, parts);
        Plane& here = canvas.touch(slot, p);
        move(here.data(), v.down.data(), mix.data(), v.up.data(), before.data());
        book(here.data(), before.data(), p);
    }
}

}  // namespace tuft::ink
