#include "brush/tuft/bundles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brush/tuft/ferrule.h"
#include "brush/tuft/tuft.h"
#include "core/noise.h"
#include "core/random.h"

namespace tuft::brush {

namespace {

using std::numbers::pi;

constexpr double kPartingLength = 4e-3;  ///< m of travel in which a bundle parts
constexpr double kMergingTime = 0.1;     ///< s in which water draws hair together
constexpr double kDrawn = 0.65;          ///< part of its width that a parted bundle loses

/// Point i of n on Vogel's spiral, all of equal area, moved by up to `shake` of their distance.
Vec2 spiral(std::uint64_t seed, std::size_t i, std::size_t n, double shake) {
    const double golden = pi * (3 - std::sqrt(5.0)), turn = 2 * pi * uniform(seed, 0);
    const double r = std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(n));
    const double w = golden * static_cast<double>(i) + turn, step = shake / std::sqrt(static_cast<double>(n));
    const Vec2 moved{r * std::cos(w) + step * (2 * uniform(seed, 2 * i + 1) - 1),
                     r * std::sin(w) + step * (2 * uniform(seed, 2 * i + 2) - 1)};
    const double out = glm::length(moved);
    return out > 1 ? moved / out : moved;
}

constexpr double kSquare = 0.8862269254527580;  ///< √π/2, half the side of the square of the unit disc's area

/// Point i of an even sequence over the mouth of a wide ferrule, each of the same area: over its half-width and the
/// half-thickness there. R₂ of Roberts (2018): any first points lie evenly, along the broad side alone too.
Vec2 in_mouth(std::uint64_t seed, std::size_t i) {
    constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
    const double x = uniform(seed, 0) + kFirst * static_cast<double>(i + 1),
                 y = uniform(seed, 1) + kSecond * static_cast<double>(i + 1);
    return {2 * (x - std::floor(x)) - 1, 2 * (y - std::floor(y)) - 1};
}

/// Part of the unit disc's area with x below the given one, and back by halving.
double area_below(double x) {
    x = std::clamp(x, -1.0, 1.0);
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / pi;
}

double with_area_below(double part) {
    static const auto table = [] {
        std::array<double, 257> t{};
        for (int k = 0; k <= 256; ++k) {
            double lo = -1, hi = 1;
            for (int i = 0; i < 50; ++i) (area_below(0.5 * (lo + hi)) < k / 256.0 ? lo : hi) = 0.5 * (lo + hi);
            t[k] = 0.5 * (lo + hi);
        }
        t[0] = -1;
        t[256] = 1;
        return t;
    }();
    const double at = 256 * std::clamp(part, 0.0, 1.0);
    const int k = std::min(static_cast<int>(at), 255);
    return table[k] + (at - k) * (table[k + 1] - table[k]);
}

/// The unit disc of which equal parts of the square |x|, |y| ≤ 1 make equal parts [Shirley1997].
Vec2 disc_of_square(const Vec2& at) {
    if (at.x == 0 && at.y == 0) return at;
    const bool wide = std::abs(at.x) > std::abs(at.y);
    const double r = wide ? at.x : at.y, w = wide ? 0.25 * pi * at.y / at.x : 0.5 * pi - 0.25 * pi * at.x / at.y;
    return r * Vec2{std::cos(w), std::sin(w)};
}

/// Position in the ring's middle disc, or in one of the sectors round it.
BranchPlace in_ring(const Vec2& place, int around) {
    const double r2 = glm::dot(place, place), inner2 = 1.0 / (around + 1);
    if (r2 < inner2) return {0, place / std::sqrt(inner2)};
    const double turn = 2 * pi / around, at = std::atan2(place.y, place.x) / turn, sector = std::round(at);
    const double out = 2 * std::min(1.0, (r2 - inner2) / (1 - inner2)) - 1;
    const int k = static_cast<int>(sector);
    return {1 + (k + around) % around, disc_of_square({out, 2 * (at - sector)})};
}

/// Readiness by rank, so that it is spread evenly: hairs side by side are much alike.
void rank_readiness(Bundles& bundles) {
    const std::size_t n = bundles.bristles.size();
    std::vector<std::pair<double, std::size_t>> order(n);
    const auto clump = [&](double x, double size, std::uint64_t salt) {
        const std::uint64_t seed = hash_bits(bundles.seed, salt);
        return value_noise((x + 2) / size, [&](std::uint64_t cell) { return uniform(seed, cell); });
    };
    for (std::size_t i = 0; i < n; ++i) {
        const double x = static_cast<double>(bundles.bristles[i].place.x);
        order[i] = {clump(x, 0.15, 20) + 0.7 * clump(x, 0.05, 21) + 0.25 * uniform(hash_bits(bundles.seed, 6), i), i};
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < n; ++i)
        bundles.bristles[order[i].second].readiness = (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
}

}  // namespace

Bundles make_bundles(const Preset& p, std::uint64_t seed) {
    Bundles out;
    out.seed = seed;
    const bool broad = has_broad_side(p);
    if (has_one_skin(p)) {
        out.strips.push_back({-1, 1});
    } else if (broad) {
        for (const FerruleSpine& spine : ferrule_spines(p)) out.strips.push_back({spine.from, spine.to});
    } else if (p.spines > 1) {
        out.around = p.spines - 1;
    }
    const auto place = [&](std::uint64_t salt, std::size_t i, std::size_t count, double shake) {
        return broad ? in_mouth(hash_bits(seed, salt), i) : spiral(hash_bits(seed, salt), i, count, shake);
    };
    // Distances are compared in metres.
    const Vec2 size = broad ? Vec2{0.5 * p.width / p.radius, 1} : Vec2{1};
    const auto n = static_cast<std::size_t>(std::max(p.bundles, 1));
    for (std::size_t k = 0; k < n; ++k) {
        out.place.push_back(n == 1 ? Vec2{0} : place(1, k, n, 0.7));
        const double u = uniform(hash_bits(seed, 2), k);
        out.holds.push_back(0.75 + 0.5 * u);
        out.resists.push_back(0.8 + 0.5 * uniform(hash_bits(seed, 3), k));
    }
    out.separation.assign(n, 0);
    const auto hairs = static_cast<std::size_t>(std::max(p.bristles, 1));
    for (std::size_t i = 0; i < hairs; ++i) {
        const Vec2 at = place(4, i, hairs, 0.9);
        std::size_t best = 0;
        for (std::size_t k = 1; k < n; ++k)
            if (glm::distance(size * at, size * out.place[k]) < glm::distance(size * at, size * out.place[best]))
                best = k;
        Bristle b;
        b.place = Vec2f(at);
        // The tip is made by the middle hairs; the outer ones end before it.
        const double shorter = uniform(hash_bits(seed, 5), i);
        b.end = static_cast<float>(1 - 0.3 * shorter * shorter * (broad ? std::abs(at.y) : glm::length(at)));
        b.bundle = static_cast<std::uint16_t>(best);
        out.bristles.push_back(b);
    }
    rank_readiness(out);
    return out;
}

void split_bundles(Bundles& bundles, const Preset& p, double stress, std::span<const double> saturation, double travel,
                   double dt) {
    const double k = std::clamp(stress, 0.0, 1.0);
    for (std::size_t i = 0; i < bundles.separation.size(); ++i) {
        const double s = i < saturation.size() ? std::clamp(saturation[i], 0.0, 1.0) : 1.0;
        double& apart = bundles.separation[i];
        const double lack = p.split_factor * (1 - s);
        if (k * lack > p.split_at * bundles.resists[i])
            apart = 1 - (1 - apart) * std::exp(-std::max(travel, 0.0) / kPartingLength);
        else if (lack < p.merge_at * bundles.resists[i])
            apart *= std::exp(-std::max(dt, 0.0) / kMergingTime);
    }
}

void rejoin_hair(Bundles& bundles) {
    std::fill(bundles.separation.begin(), bundles.separation.end(), 0.0);
}

Vec2 place_of(const Bundles& bundles, const Bristle& bristle) {
    const Vec2 at(bristle.place);
    return at + kDrawn * bundles.separation[bristle.bundle] * (bundles.place[bristle.bundle] - at);
}

BranchPlace in_branch(const Bundles& bundles, const Vec2& place, int count) {
    if (!bundles.strips.empty()) {
        const std::vector<HairStrip>& strips = bundles.strips;
        std::size_t k = 0;
        while (k + 1 < strips.size() && place.x >= strips[k].to) ++k;
        const double x = 2 * (place.x - strips[k].from) / (strips[k].to - strips[k].from) - 1;
        return {static_cast<int>(k), kSquare * Vec2{std::clamp(x, -1.0, 1.0), place.y}};
    }
    if (bundles.around > 0) return in_ring(place, bundles.around);
    if (count <= 1) return {0, place};
    const double at = count * area_below(place.x);
    const int branch = std::clamp(static_cast<int>(at), 0, count - 1);
    const double x = with_area_below(at - branch);
    const double before = std::sqrt(std::max(0.0, 1 - place.x * place.x));
    const double chord = std::sqrt(std::max(0.0, 1 - x * x));
    return {branch, {x, before > 1e-9 ? std::clamp(place.y / before, -1.0, 1.0) * chord : 0}};
}

HairCells hair_cells(const Preset& p) {
    HairCells cells{.ends = {0.45, 0.7, 0.88, 1}, .capacities = {}};
    constexpr int kPerCell = 64;
    double begin = 0, sum = 0;
    for (const double end : cells.ends) {
        double volume = 0;
        for (int i = 0; i < kPerCell; ++i) {
            const double r = rest_radius(p, begin + (end - begin) * (i + 0.5) / kPerCell) / p.radius;
            volume += r * r * (end - begin) / kPerCell;
        }
        cells.capacities.push_back(volume);
        sum += volume;
        begin = end;
    }
    for (double& v : cells.capacities) v /= sum;
    return cells;
}

}  // namespace tuft::brush
