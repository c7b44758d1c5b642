#include "stroke/contact/hair_tone.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/ease.h"
#include "core/geometry/solid_noise.h"
#include "core/hat.h"
#include "core/simd.h"

namespace tuft::stroke {
namespace {

constexpr double kOfLoad = 0.5;                       // part of the difference in load that shows in the film
constexpr double kStrands = 0.04;                     // rms of the film over strands
constexpr double kStrand = 0.16e-3, kChange = 20e-3;  // metres across a strand, and along, over which it changes
constexpr double kFull = 0.25, kGone = 0.625;         // cells, half a texel each, over a strand
constexpr double kReach = 1.5;                        // spacings of bundles over which a load is averaged
constexpr double kLeastSpan = 0.2e-3;                 // metres
constexpr float kSeen = 0.01F;                        // departure from the mean that is seen

double beside(const footprint::EdgeHair& edge, const Vec2& at) {
    const Vec2 d = at - edge.foot;
    return edge.direction.x * d.y - edge.direction.y * d.x;
}

/// Load of each bundle: saturation of its cells times what it holds.
Recycled<double> loads_of(const ink::Reservoir& reservoir, const brush::Bundles& bundles) {
    const std::size_t cells = reservoir.n_cells();
    Recycled<double> loads(bundles.place.size(), 0);
    for (std::size_t k = 0; k < loads.size() && k < reservoir.n_bundles(); ++k) {
        // The last cell lies on the surface.
        loads[k] = reservoir.saturation((k + 1) * cells - 1) * bundles.holds[k];
    }
    return loads;
}

/// A hat over the samples, and what it weighs.
struct WeightedHat {
    double centre = 0, reach = 1;  ///< samples; `reach`: half width
    double height = 0, value = 0;
};

/// Adds a hat, and it times its value, to the samples from `first` to `last`.
TUFT_CLONES void add_hat(double* __restrict weight, double* __restrict load, int first, int last,
                         const WeightedHat& of) {
    const auto [centre, reach, height, value] = of;
    for (int i = first; i <= last; ++i) {
        const double share = height * hat(i - centre, reach);
        weight[i] += share;
        load[i] += share * value;
    }
}

/// Sums of hats about the points, by sample.
struct Sums {
    std::array<double, ink::kToneSamples> weight{}, load{};

    void add(double centre, double reach, double w, double value) {
        const int first = std::max(0, static_cast<int>(std::ceil(centre - reach))),
                  last = std::min(ink::kToneSamples - 1, static_cast<int>(std::floor(centre + reach)));
        add_hat(weight.data(), load.data(), first, last, {centre, reach, w, value});
    }
};

/// Value noise over strands at one place along the path, of unit rms.
class StrandNoise {
  public:
    StrandNoise(double along, std::uint64_t seed) : seed_(seed) {
        const double row = std::floor(along);
        row_ = static_cast<std::int64_t>(row);
        blend_ = fade(along - row);
    }

    double at(double x) {
        const double strand = std::floor(x);
        const auto i = static_cast<std::int64_t>(strand);
        if (!(strand_ == i && begun_)) {
            left_ = begun_ && strand_ + 1 == i ? right_ : corner(i);
            right_ = corner(i + 1);
            strand_ = i;
            begun_ = true;
        }
        return std::lerp(left_, right_, fade(x - strand)) / rms();
    }

  private:
    /// Of values uniform in [−1, 1], each blended along x and along the path: ⅓ (26/35)².
    static double rms() { return std::sqrt(1.0 / 3) * 26 / 35; }
    double corner(std::int64_t i) const {
        return std::lerp(solid_noise_corner(i, row_, 0, seed_), solid_noise_corner(i, row_ + 1, 0, seed_), blend_);
    }

    std::uint64_t seed_;
    std::int64_t row_ = 0, strand_ = 0;
    double blend_ = 0, left_ = 0, right_ = 0;
    bool begun_ = false;
};

}  // namespace

void HairTone::compute(const footprint::EdgeHair& edge, double cell, const ink::Reservoir& reservoir,
                       const brush::Bundles& bundles, std::span<const footprint::HairContactPoint> points) {
    constexpr int n = ink::kToneSamples;
    computed_ = false;
    if (points.empty()) return;
    double lo = 1e9, hi = -1e9;
    Recycled<bool> touches(bundles.place.size(), false);
    for (const footprint::HairContactPoint& p : points) {
        const double x = beside(edge, p.at);
        lo = std::min(lo, x);
        hi = std::max(hi, x);
        touches[p.bundle] = true;
    }
    const auto count = static_cast<double>(std::count(touches.begin(), touches.end(), true));
    if (hi - lo < kLeastSpan) return;
    const double per_metre = (n - 1) / (hi - lo), reach = kReach * (n - 1) / std::max(2.0, count);
    const Recycled<double> loads = loads_of(reservoir, bundles);
    Sums sums;
    double weight = 0, load = 0;
    for (const footprint::HairContactPoint& p : points) {
        sums.add((beside(edge, p.at) - lo) * per_metre, std::max(reach, 2.0), p.length, loads[p.bundle]);
        weight += p.length;
        load += p.length * loads[p.bundle];
    }
    if (!(load > 0)) return;
    const double mean = load / weight;
    const double strands = kStrands * smooth_step((kGone - cell / kStrand) / (kGone - kFull));
    StrandNoise noise(edge.travel / kChange, edge.seed + 3);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double relative = sums.weight[i] > 0 ? sums.load[i] / sums.weight[i] / mean : 1;
        double film = 1 + kOfLoad * (relative - 1);
        if (strands > 0) film += strands * noise.at((lo + i / per_metre) / kStrand);
        film_[i] = static_cast<float>(std::max(film, 0.0));
        sum += static_cast<double>(film_[i]);
    }
    even_ = true;
    for (float& f : film_) {
        f *= static_cast<float>(n / sum);
        even_ = even_ && std::abs(f - 1) < kSeen;
    }
    from_ = lo;
    to_ = hi;
    updated_at_ = edge.travel;
    computed_ = true;
}

ink::FilmTone HairTone::at(const footprint::EdgeHair& edge, const Frame& frame, double contrast) const {
    ink::FilmTone tone;
    if (!computed_ || even_ || !(contrast > 0)) return tone;
    const Vec2 left{-edge.direction.y, edge.direction.x};
    tone.even = false;
    tone.origin = frame.to_world(Vec3(edge.foot + from_ * left, 0));
    tone.across = (ink::kToneSamples - 1) / (to_ - from_) * (left.x * frame.t + left.y * frame.b);
    for (int i = 0; i < ink::kToneSamples; ++i) tone.film[i] = 1 + static_cast<float>(contrast) * (film_[i] - 1);
    return tone;
}

}  // namespace tuft::stroke
