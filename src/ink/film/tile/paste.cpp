#include "ink/film/tile/paste.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"
#include "ink/film/tile/film_tile.h"
#include "ink/texels/drying.h"
#include "ink/texels/pool.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kModes = 64;             // the finest waves are a thirtieth of the width
constexpr double kTension = 0.03;      // N/m, of oil and of water with binder
constexpr double kDensity = 1500;      // kg/m³ of heavy paint
constexpr double kGravity = 9.81;      // m/s²
constexpr double kFurrowWidth = 0.35;  // half width of a furrow over the mean distance of bundles
constexpr double kRimWidth = 1.5;      // of what is pushed out, over the film's thickness
constexpr double kRounded = 0.02;      // of its height: waves below that are rounded off
constexpr double kLeastFilm = 0.15;    // of the mean: hair never scrapes to the surface
constexpr double kRub = 0.6;           // of what bundles rub goes by where they lie, the rest is the liquid's

constexpr double kWear = 1e-3;                      // part of what hair slides over that comes off
constexpr double kPunch = 2 + 3.14159265358979324;  // what bears over what shears, under a flat punch

using Texels = std::array<float, kN>;

/// Leaves the height where it counts as paste's.
TUFT_CLONES void where_dry(float* __restrict height, const float* __restrict film, const float* __restrict pores) {
    for (int t = 0; t < kN; ++t) {
        const float h = height[t] > static_cast<float>(kPlain) ? height[t] : 0;
        height[t] = film[t] + pores[t] > 0 ? 0 : h;
    }
}

/// Paste that each texel gets and gives, film units.
struct Volumes {
    alignas(64) Texels down, up;
};

/// Planes, [256], and rates that an exchange of paste reads.
struct PasteExchangeInput {
    const float* coverage;    ///< 0–1
    const float* full;        ///< film units that the tuft leaves where it covers all
    const float* here;        ///< film units, now
    const float* before;      ///< film units, before the stroke
    float rate = 0;           ///< 0–1, share of the lack that this step makes up
    float keep = 1;           ///< 0–1, share of the earlier paste that is not dug up
    float exchange = 0;       ///< 0–1, share that is renewed from the tuft
    float free_capacity = 0;  ///< film units that the tuft can take up
    float capacity = 0;       ///< film units that the surface holds
};

TUFT_CLONES void exchange_volumes(Volumes& out, const PasteExchangeInput& in) {
    const float* __restrict coverage = in.coverage, * __restrict full = in.full;
    const float* __restrict here = in.here, * __restrict before = in.before;
    const float rate = in.rate, keep = in.keep, exchange = in.exchange;
    const float free_capacity = in.free_capacity, capacity = in.capacity;
    for (int t = 0; t < kN; ++t) {
        const float f = coverage[t], w = here[t];
        float goal = before[t] + f * full[t];
        goal = goal < capacity ? goal : capacity;
        const float touched = f > 0 ? rate : 0;
        const float lack = positive(goal - w) * touched;
        const float lift = f * positive(w - keep * before[t] - full[t]) * rate;
        const float renewed = f * exchange * w;
        out.down[t] = lack + renewed;
        out.up[t] = renewed + (lift < free_capacity ? lift : free_capacity);
    }
}

/// up becomes the part of a texel's paste that goes.
TUFT_CLONES void part_of(float* __restrict up, const float* __restrict here) {
    for (int t = 0; t < kN; ++t) {
        const float part = here[t] > 0 ? up[t] / here[t] : 0;
        up[t] = part < 1 ? part : 1;
    }
}

/// Planes that the exchange of one pigment reads, [256].
struct PasteMixture {
    const float* part;      ///< 0–1, share of a texel's paste that goes up
    const float* volume;    ///< film units of paste that come down
    const float* mix;       ///< the pigment's amount in a film unit of the paste, times `strength`
    const float* strength;  ///< of the paste; 0: none
};

/// Moves `up` of a plane to the tuft and `down` of the mixture to the plane.
TUFT_CLONES void exchange_pigment(float* __restrict w, float* __restrict up, float* __restrict down,
                                  const PasteMixture& in) {
    const float* __restrict part = in.part, * __restrict volume = in.volume;
    const float* __restrict mix = in.mix, * __restrict strength = in.strength;
    for (int t = 0; t < kN; ++t) {
        up[t] = w[t] * part[t];
        down[t] = strength[t] > 0 ? volume[t] * mix[t] / strength[t] : 0;
        w[t] = (w[t] - up[t]) + down[t];
    }
}

/// About exp(−x²), nothing from x = 2 on.
double bump(double x) {
    const double y = 1 - 0.25 * x * x;
    return y > 0 ? (y * y) * (y * y) : 0;
}

/// cos(π j / n), by turning step for step: the same on every machine.
std::array<double, 2 * (kFirmnessSamples - 1)> make_wave() {
    static_assert(kFirmnessSamples - 1 == 128);
    constexpr double kCos = 0.99969881869620422, kSin = 0.024541228522912288;  // of π / 128
    std::array<double, 2 * (kFirmnessSamples - 1)> wave;
    double c = 1, s = 0;
    for (double& w : wave) {
        w = c;
        const double next = c * kCos - s * kSin;
        s = s * kCos + c * kSin;
        c = next;
    }
    return wave;
}

/// How much of the firmest bundle lies at each place, 0–1.
std::array<double, kFirmnessSamples> push_share(std::span<const BundleFirmness> bundles) {
    std::array<double, kFirmnessSamples> out;
    double firm = 0;
    for (const BundleFirmness& bundle : bundles) firm += bundle.weight;
    const double half = firm > 0 ? kFurrowWidth / firm : 1;  // of the width: firm bundles lie 1 / firm apart
    for (int i = 0; i < kFirmnessSamples; ++i) {
        double pushed = 0;
        for (const BundleFirmness& bundle : bundles)
            pushed += bundle.weight * bump((double(i) / (kFirmnessSamples - 1) - bundle.at) / half);
        out[i] = std::min(pushed, 1.0);
    }
    return out;
}

/// Furrows and rims before they level, over the mean.
std::array<double, kFirmnessSamples> plough(std::span<const BundleFirmness> bundles, const FurrowOptions& o) {
    std::array<double, kFirmnessSamples> film = push_share(bundles);
    const double rim = std::max(kRimWidth * o.film / o.width, 1.5 / kFirmnessSamples);
    for (int i = 0; i < kFirmnessSamples; ++i) {
        const double u = double(i) / (kFirmnessSamples - 1);
        film[i] = std::max(1 - o.depth * film[i], kLeastFilm) + o.rim * bump(std::min(u, 1 - u) / rim);
    }
    return film;
}

}  // namespace

FurrowDepths furrow_depths(std::span<const BundleFirmness> bundles, const FurrowOptions& o) {
    FurrowDepths out;
    out.fill(1);
    if (!(o.yield > 0) || !(o.width > 0) || !(o.film > 0)) return out;
    const std::array<double, kFirmnessSamples> film = plough(bundles, o);
    constexpr int kLast = kFirmnessSamples - 1;
    static const std::array<double, 2 * kLast> wave = make_wave();
    double mean = 0;
    for (int i = 0; i < kFirmnessSamples; ++i) mean += (i == 0 || i == kLast ? 0.5 : 1.0) * film[i] / kLast;
    std::array<double, kFirmnessSamples> levelled{};
    for (int n = 1; n <= kModes; ++n) {
        double a = 0;
        for (int i = 0; i < kFirmnessSamples; ++i)
            a += (i == 0 || i == kLast ? 1.0 : 2.0) * film[i] * wave[n * i % (2 * kLast)] / kLast;
        const double k = 3.14159265358979324 * n / o.width;
        const double most = o.yield / (kTension * k * k * k * o.film) / o.film;  // over the mean film
        const double amplitude = std::clamp(a / mean, -most, most);
        for (int i = 0; i < kFirmnessSamples; ++i) levelled[i] += amplitude * wave[n * i % (2 * kLast)];
    }
    for (int i = 0; i < kFirmnessSamples; ++i) out[i] = static_cast<float>(std::max(1 + levelled[i], 0.0));
    return out;
}

FurrowDepths rub_of(std::span<const BundleFirmness> bundles) {
    const std::array<double, kFirmnessSamples> lies = push_share(bundles);
    double mean = 0;
    for (const double l : lies) mean += l / kFirmnessSamples;
    FurrowDepths out;
    for (int i = 0; i < kFirmnessSamples; ++i)
        out[i] = static_cast<float>(mean > 0 ? 1 + kRub * (lies[i] / mean - 1) : 1);
    return out;
}

double standing_film(double yield) {
    return std::max(yield, 0.0) / (kDensity * kGravity) / kFilmUnit;
}

double levelling_length(double yield, double film) {
    return yield > 0 && film > 0 ? std::cbrt(kTension * kRounded * film * film / yield) : 0;
}

Plane open_pigment(const Canvas& canvas, std::uint32_t slot) {
    Plane sum;
    sum.fill(0);
    for (int p = 0; p < kMaxPigments; ++p)
        if (const Plane* w = canvas.plane(slot, p)) add_plane(sum.data(), w->data());
    return sum;
}

double loosened(const Rub& rub) {
    return rub.yield > 0
               ? kWear * std::max(rub.pressure, 0.0) * std::max(rub.length, 0.0) / (kPunch * rub.yield) / kFilmUnit
               : 0;
}

Plane paste_height(const Canvas& canvas, std::uint32_t slot) {
    Plane height;
    height.fill(0);
    for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
        if (const Plane* w = canvas.plane(slot, p))
            add_scaled_plane(height.data(), w->data(), 1e6f * canvas.pigments()[p].height);
    if (!(wet::greatest(height.data()) > static_cast<float>(kPlain))) {
        height.fill(0);
        return height;
    }
    static constexpr Plane kDry{};
    const Plane *film = canvas.liquid(slot, Liquid::film), *pores = canvas.liquid(slot, Liquid::pores);
    where_dry(height.data(), (film ? film : &kDry)->data(), (pores ? pores : &kDry)->data());
    return height;
}

bool bed_paste(Canvas& canvas, std::uint32_t slot, const Plane& height, std::span<const float, kN> flooded,
               double loose) {
    if (!(wet::greatest(height.data()) > 0)) return false;
    const Plane all = open_pigment(canvas, slot);
    Texels part;
    bool any = false;
    for (int t = 0; t < kN; ++t) {
        const bool lies = flooded[t] > 0 && height[t] > 0;
        part[t] = lies ? positive(1 - static_cast<float>(loose) / all[t]) : 0;
        any = any || lies;
    }
    if (any) close_parts(canvas, slot, part);
    return any;
}

void deposit_paste(Canvas& canvas, const ContactTile& tile, const PasteParams& params, const NodeMixes& mixes,
                   const Plane& before, const PasteExchange& exchange) {
    const auto& [covered, ds] = tile.stamp;
    const auto& [slot, coverage, area] = covered;
    const HatBasis& hats = tile.hats;
    if (hats.count == 0 || !(ds > 0)) return;
    alignas(64) Texels full, strength{}, up, down, old;
    alignas(64) std::array<Texels, kMaxPigments> mix;
    std::array<bool, kMaxPigments> used{};
    for (int p = 0; p < kMaxPigments; ++p) {
        for (int k = 0; k < hats.count; ++k) used[p] = used[p] || mixes[p][hats.node[k]] > 0;
        if (!used[p]) continue;
        interpolate(mix[p], hats, mixes[p]);
        add_plane(strength.data(), mix[p].data());
    }
    furrow_depth_at(full, tile.places, params.furrows);
    for (int t = 0; t < kN; ++t) full[t] *= static_cast<float>(params.target) * strength[t];
    const Plane here = open_pigment(canvas, slot);
    Volumes v;
    exchange_volumes(v, {.coverage = coverage.data(),
                         .full = full.data(),
                         .here = here.data(),
                         .before = before.data(),
                         .rate = static_cast<float>(-std::expm1(-ds / params.transfer_length)),
                         .keep = static_cast<float>(1 - params.dig),
                         .exchange = static_cast<float>(params.exchange),
                         .free_capacity = static_cast<float>(params.free_capacity),
                         .capacity = static_cast<float>(params.capacity)});
    part_of(v.up.data(), here.data());
    std::array<double, kNodes> shares;
    MixtureGiven mixture(exchange.given, mixes, hats);
    for (int p = 0; p < kMaxPigments; ++p) {
        const Plane* there = canvas.plane(slot, p);
        if (!used[p] && !there) continue;
        if (!used[p]) mix[p].fill(0);
        Plane& w = canvas.touch(slot, p);
        old = w;
        exchange_pigment(w.data(), up.data(), down.data(),
                         {v.up.data(), v.down.data(), mix[p].data(), strength.data()});
        const double stored = change_sum(w.data(), old.data(), area.data());
        double lifted = 0;
        if (there)
            integrate_hats(shares, hats, up.data(), area);
        else
            shares.fill(0);
        for (int k = 0; k < hats.count; ++k) lifted += shares[k];
        // What rounding makes of it: nothing may be given that does not come down.
        if (!used[p]) lifted = std::max(-stored, 0.0);
        const double given = std::max(stored + lifted, 0.0);
        distribute(exchange.taken, p, given - stored, shares, hats);
        integrate_hats(shares, hats, down.data(), area);
        mixture.pigment(p, given, shares);
    }
    mixture.water();
}

}  // namespace tuft::ink
