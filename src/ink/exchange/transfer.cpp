#include "ink/exchange/transfer.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kWater = kMaxPigments;
constexpr int kSums = 16;
constexpr double kSkinFilm = 4;                                // film units on full hair
constexpr double kHalfFull = 0.5;                              // saturation from which hair is wet outside all over
constexpr double kSkinTime = 0.3;                              // seconds
constexpr double kExchangeLength = 4e-3, kExchangeTime = 0.5;  // metres, seconds
constexpr double kGentle = 0.3;                                // of the exchange under firm pressure
constexpr double kMostGiven = 0.999;  // of the liquid: rounding may not take more than there is

using Texels = std::array<float, kN>;

/// a = a b, 1 at most.
TUFT_CLONES void scale(float* __restrict a, const float* __restrict b) {
    for (int t = 0; t < kN; ++t) {
        const float x = a[t] * b[t];
        a[t] = x < 1 ? x : 1;
    }
}

/// Liquid that each texel gets and gives, film units.
struct Volumes {
    alignas(64) Texels down, up;
};

/// Planes that an exchange reads, [256], film units but for the first and the last.
struct ExchangePlanes {
    const float* coverage;  ///< 0–1
    const float* goal;      ///< film that the hair would leave
    const float* liquid;    ///< on the surface
    const float* total;     ///< on the surface and in its pores
    const float* film;      ///< on the hair
    const float* exchange;  ///< 0–1, share that changes sides in this step
};

TUFT_CLONES void exchange_volumes(Volumes& out, const ExchangePlanes& in, const TransferParams& p, float rate) {
    const float* __restrict coverage = in.coverage, * __restrict goal = in.goal, * __restrict w = in.liquid;
    const float* __restrict total = in.total, * __restrict film = in.film, * __restrict exchange = in.exchange;
    for (int t = 0; t < kN; ++t) {
        const float touched = coverage[t] > 0 ? 1.0f : 0.0f;
        const float lack = positive(smaller(goal[t] - w[t], p.deposit.capacity - total[t])) * rate;
        const float n = smaller(lack + coverage[t] * p.pour, film[t] * touched);
        const float part = coverage[t] * exchange[t];
        const float x = part * smaller(w[t], film[t] - n);
        const float over = positive(w[t] - larger(goal[t], p.deposit.target)) * part * p.uptake;
        const float lift = smaller(over, smaller(p.free_capacity, w[t] - x));
        out.down[t] = n + x;
        out.up[t] = x + lift;
    }
}

/// up becomes the part of the open film's pigments that goes with the liquid.
TUFT_CLONES void lifted_part(float* __restrict up, const float* __restrict total, const float* __restrict pigments) {
    for (int t = 0; t < kN; ++t) up[t] = total[t] > 0 ? up[t] / larger(total[t], pigments[t]) : 0;
}

/// down becomes the part that leaves of what the liquid can give.
TUFT_CLONES void given_part(float* __restrict part, const float* __restrict down, const float* __restrict film) {
    for (int t = 0; t < kN; ++t) part[t] = film[t] > 0 ? down[t] / film[t] : 0;
}

/// p after `up` left and `down` came. Returns Σ of what was stored · area, in double.
struct Changes {
    double sums[kSums] = {};

    inline __attribute__((always_inline)) void move(int lane, float& p, float up, float down, float area) {
        const float before = p;
        p = (before - up) + down;
        sums[lane] += (static_cast<double>(p) - static_cast<double>(before)) * static_cast<double>(area);
    }
    double sum() const {
        double all = 0;
        for (const double s : sums) all += s;
        return all;
    }
};

TUFT_CLONES double move_liquid(float* __restrict w, const float* __restrict up, const float* __restrict down,
                               const float* __restrict area) {
    Changes changes;
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) changes.move(i, w[t + i], up[t + i], down[t + i], area[t + i]);
    return changes.sum();
}

/// `up`: what goes up of a plane, its part `lifted`.
TUFT_CLONES double move_pigment(float* __restrict p, float* __restrict up, const float* __restrict lifted,
                                const float* __restrict part, const float* __restrict film,
                                const float* __restrict area) {
    Changes changes;
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) {
            const float leaves = p[t + i] * lifted[t + i];
            up[t + i] = leaves;
            changes.move(i, p[t + i], leaves, part[t + i] * film[t + i], area[t + i]);
        }
    return changes.sum();
}

/// Planes lie here and there: all of a tile's are fetched while the first sums are made.
void prefetch(const Plane* plane) {
    if (!plane) return;
    for (int t = 0; t < kN; t += 64 / static_cast<int>(sizeof(float))) __builtin_prefetch(plane->data() + t);
}

/// What a tile's nodes gave and took, before it is made to agree with what was stored.
struct Booked {
    std::array<double, kNodes> part{};  ///< m² that gave all that lay over it
    /// By the surface's planes, of each the hats; water: all liquid.
    std::array<std::array<double, kNodes>, Reservoir::kPlanes> taken{};
    Reservoir::Content stored{};  ///< likewise, given less taken
};

/// Deals the stored change of each plane out to the nodes: what they took, and the rest by what
/// lies over them, where the sums differ by the rounding of the texels.
void settle(const Booked& b, const HatBasis& hats, const TransferParams& params, NodeContents& given) {
    double all = 0;
    for (int k = 0; k < hats.count; ++k) all += b.part[k] + b.taken[kWater][k];
    Reservoir::Content stored = b.stored;
    for (int p = 0; p < kMaxPigments; ++p) stored[kWater] -= stored[p];  // the liquid counts its pigments
    for (int p = 0; p < Reservoir::kPlanes; ++p) {
        std::array<double, kNodes> net;
        double sum = 0;
        for (int k = 0; k < hats.count; ++k) {
            double taken = b.taken[p][k];
            for (int q = 0; q < kMaxPigments && p == kWater; ++q) taken -= b.taken[q][k];
            net[k] = b.part[k] * static_cast<double>(params.film[p][hats.node[k]]) - taken;
            sum += net[k];
        }
        const double left = stored[p] - sum;
        for (int k = 0; k < hats.count; ++k) {
            const double share = all > 0 ? (b.part[k] + b.taken[kWater][k]) / all : 1.0 / hats.count;
            given[hats.node[k]][p] += net[k] + left * share;
        }
    }
}

}  // namespace

namespace {

/// Where the hair has left the surface, what was on it spreads among the rest in line with it,
/// which lacks some as it comes down: one film wets it all. What nobody lacks goes `back`.
void pass_on(SurfaceLiquid& liquid, NodeContents& back, const std::array<double, kNodes>& want, int across) {
    constexpr double kSpare = 1.25;  // of what a node wants
    std::array<double, kAlong> lack{}, over{};
    double lacking = 0, loose = 0;
    for (int i = 0; i < kAlong; ++i) {
        const double volume = liquid.volume(i * kAcross + across), most = want[i * kAcross + across];
        lacking += lack[i] = std::max(0.0, most - volume);
        loose += over[i] = std::max(0.0, volume - kSpare * most);
    }
    if (!(loose > 0)) return;
    Reservoir::Content sum{};
    for (int i = 0; i < kAlong; ++i) {
        const int node = i * kAcross + across;
        if (!(over[i] > 0)) continue;
        const double out = over[i] / liquid.volume(node), stays = std::min(1.0, lacking / loose);
        for (int p = 0; p < Reservoir::kPlanes; ++p) {
            const double v = out * liquid.content[node][p];
            liquid.content[node][p] -= v;
            sum[p] += stays * v;
            back[node][p] += v - stays * v;
        }
    }
    for (int i = 0; i < kAlong && lacking > 0; ++i)
        for (int p = 0; p < Reservoir::kPlanes; ++p)
            liquid.content[i * kAcross + across][p] += lack[i] / lacking * sum[p];
}

}  // namespace

std::array<double, kAlong> firmness(const NodeAreas& areas) {
    std::array<double, kAlong> width{};
    double widest = 0;
    for (int i = 0; i < kAlong; ++i) {
        for (int j = 0; j < kAcross; ++j) width[i] += areas[i * kAcross + j];
        if (i == 0 || i == kAlong - 1) width[i] *= 2;  // of an outer row's hat half is there
        widest = std::max(widest, width[i]);
    }
    for (double& w : width) w = widest > 0 ? w / widest : 1;
    return width;
}

double SurfaceLiquid::volume(int node) const {
    return sum_of(content[node]);
}

void withdraw(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& contact, const NodeContact& nodes) {
    absorb(tuft, liquid.content, nodes, contact);
    liquid.content = {};
}

void refresh(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& contact, const NodeContact& nodes,
             const NodeAreas& areas, const ContactStep& step) {
    const double filled = std::min(1.0, saturation_at(tuft, contact) / kHalfFull), wet = filled * filled;
    const double part = -std::expm1(-std::max(step.dt, 0.0) / kSkinTime);
    std::array<double, kNodes> want, lack;
    NodeContents back{};
    for (int node = 0; node < kNodes; ++node) want[node] = (kSkinFilm * wet + step.pour) * areas[node];
    for (int across = 0; across < kAcross; ++across) pass_on(liquid, back, want, across);
    for (int node = 0; node < kNodes; ++node)
        for (int p = 0; p < Reservoir::kPlanes; ++p) {
            const double v = part * liquid.content[node][p];
            liquid.content[node][p] -= v;
            back[node][p] += v;
        }
    absorb(tuft, back, nodes, contact);
    double all = 0;
    for (int node = 0; node < kNodes; ++node) {
        lack[node] = std::max(0.0, want[node] - liquid.volume(node));
        all += lack[node];
    }
    if (!(all > 0)) return;
    const double within = std::min(1.0, tuft.remaining() / all);
    for (double& amount : lack) amount *= within;
    const NodeContents fresh = draw(tuft, lack, nodes, contact, filled >= 1 || step.pour > 0);
    for (int node = 0; node < kNodes; ++node)
        for (int p = 0; p < Reservoir::kPlanes; ++p) liquid.content[node][p] += fresh[node][p];
}

TransferParams transfer_params(const SurfaceLiquid& liquid, const Reservoir& tuft, const ContactCells& contact,
                               const NodeAreas& areas, const DepositParams& deposit, const ContactStep& step) {
    TransferParams out;
    out.deposit = deposit;
    out.rub.fill(1);
    const double progress = step.ds / kExchangeLength + std::max(step.dt, 0.0) / kExchangeTime;
    const double most = progress * (kGentle + (1 - kGentle) * std::clamp(step.stress, 0.0, 1.0));
    const std::array<double, kAlong> firm = firmness(areas);
    for (int node = 0; node < kNodes; ++node)
        out.exchange[node] = static_cast<float>(-std::expm1(-most * firm[node / kAcross]));
    out.uptake = static_cast<float>(std::clamp(1 - saturation_at(tuft, contact), 0.0, 1.0));
    double area = 0;
    for (const double a : areas) area += a;
    out.free_capacity = static_cast<float>(area > 0 ? free_capacity(tuft, contact) / area : 0);
    for (int node = 0; node < kNodes; ++node) {
        if (!(areas[node] > 0)) continue;
        for (int p = 0; p < Reservoir::kPlanes; ++p)
            out.film[p][node] = static_cast<float>(kMostGiven * std::max(0.0, liquid.content[node][p]) / areas[node]);
    }
    return out;
}

void transfer(Canvas& canvas, const ContactTile& tile, const TransferParams& params, NodeContents& given) {
    const auto& [covered, ds] = tile.stamp;
    const auto& [slot, coverage, area] = covered;
    const HatBasis& hats = tile.hats;
    if (hats.count == 0) return;
    prefetch(canvas.liquid(slot, Liquid::film));
    prefetch(canvas.liquid(slot, Liquid::pores));
    for (int p = 0; p < kMaxPigments; ++p) prefetch(canvas.plane(slot, p));
    std::array<float, kNodes> over{};  // film units of all planes
    for (int k = 0; k < hats.count; ++k)
        for (int p = 0; p < Reservoir::kPlanes; ++p) over[hats.node[k]] += params.film[p][hats.node[k]];
    alignas(64) Texels film, exchange, goal, total, pigments{}, part, up;
    interpolate(film, hats, over);
    interpolate(exchange, hats, params.exchange);
    furrow_depth_at(part, tile.places, params.rub);
    scale(exchange.data(), part.data());
    film_goals(goal, coverage, params.deposit);
    Plane& w = canvas.touch_liquid(slot, Liquid::film);
    const Plane* s = canvas.liquid(slot, Liquid::pores);
    for (int t = 0; t < kN; ++t) total[t] = s ? w[t] + (*s)[t] : w[t];
    Volumes v;
    const auto rate = static_cast<float>(-std::expm1(-ds / static_cast<double>(params.deposit.transfer_length)));
    exchange_volumes(v, {coverage.data(), goal.data(), w.data(), total.data(), film.data(), exchange.data()}, params,
                     rate);
    given_part(part.data(), v.down.data(), film.data());
    Booked booked;
    integrate_hats(booked.part, hats, part.data(), area);
    integrate_hats(booked.taken[kWater], hats, v.up.data(), area);
    booked.stored[kWater] = move_liquid(w.data(), v.up.data(), v.down.data(), area.data());
    for (int p = 0; p < kMaxPigments; ++p)
        if (const Plane* here = canvas.plane(slot, p)) add_plane(pigments.data(), here->data());
    lifted_part(v.up.data(), total.data(), pigments.data());
    for (int p = 0; p < kMaxPigments; ++p) {
        float most = 0;
        for (int k = 0; k < hats.count; ++k) most = std::max(most, params.film[p][hats.node[k]]);
        const bool there = canvas.plane(slot, p) != nullptr;
        if (!(most > 0) && !there) continue;
        interpolate(film, hats, params.film[p]);
        booked.stored[p] =
            move_pigment(canvas.touch(slot, p).data(), up.data(), v.up.data(), part.data(), film.data(), area.data());
        if (there) integrate_hats(booked.taken[p], hats, up.data(), area);
    }
    settle(booked, hats, params, given);
}

}  // namespace tuft::ink
