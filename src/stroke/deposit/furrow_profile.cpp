#include "stroke/deposit/furrow_profile.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"
#include "core/random.h"

namespace tuft::stroke {
namespace {

constexpr double kSettleLength = 1.5e-3;  // metres of travel in which bundles come to lie otherwise
constexpr double kRollLength = 9e-3;      // metres over which a furrow deepens and fades

/// Noise in [0, 1] along a line, smooth over one unit.
double noise(std::uint64_t seed, double x) {
    return value_noise(x, [&](std::uint64_t cell) { return uniform(seed, cell); });
}

}  // namespace

Recycled<ink::BundleFirmness> FurrowProfile::advance(const TuftInHand& tuft, const HairContact& hair, double travel) {
    const ink::Reservoir& reservoir = tuft.brush.reservoir;
    const brush::Bundles& bundles = tuft.brush.tuft.bundles;
    const std::size_t n = reservoir.n_bundles(), n_cells = reservoir.n_cells();
    const ink::ContactCells& cells = hair.cells();
    Recycled<double> lies(n, 0);
    for (std::size_t i = 0; i < cells.size(); ++i) lies[i / n_cells] += static_cast<double>(cells[i]);
    const double firmest = *std::max_element(lies.begin(), lies.end());
    const double part = firmness_.empty() ? 1 : -std::expm1(-(travel - updated_at_) / kSettleLength);
    firmness_.resize(n, 0);
    updated_at_ = travel;
    Recycled<ink::BundleFirmness> profile;
    profile.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
        firmness_[k] += part * ((firmest > 0 ? lies[k] / firmest : 0) - firmness_[k]);
        const double roll = noise(hash_bits(bundles.seed, 3000 + k), travel / kRollLength);
        profile.push_back({0.5 + 0.5 * hair.orientation() * bundles.place[k].x, firmness_[k] * (0.4 + 0.6 * roll)});
    }
    return profile;
}

}  // namespace tuft::stroke
