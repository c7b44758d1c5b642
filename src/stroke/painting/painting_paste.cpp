#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "footprint/shoulder.h"
#include "stroke/painting/painting_hand.h"

/// Thick paint under the tuft.
namespace tuft::stroke {
namespace {

constexpr double kSettling = 1.5e-3;   // metres of travel in which bundles come to lie otherwise
constexpr double kRolling = 9e-3;      // metres over which a furrow deepens and fades
constexpr double kShoulder = 1.5;      // length of the rounded edge over the film's thickness
constexpr double kMixing = 25e-3;      // metres of travel in which hair and texel exchange their paste
// Under a gentle and, added to that, a firm press.
constexpr double kDepth[] = {0.35, 0.45};  // of the furrows
constexpr double kRim[] = {0.1, 0.5};      // pushed out at the sides
constexpr double kDig[] = {0.1, 0.35};     // of the paste that lies there

/// Value noise in [0, 1] along a line, smooth over one unit.
double fade(std::uint64_t seed, double x) {
    const double cell = std::floor(x), f = x - cell, g = f * f * (3 - 2 * f);
    const double a = uniform(seed, static_cast<std::uint64_t>(cell)), b = uniform(seed, static_cast<std::uint64_t>(cell) + 1);
    return a + g * (b - a);
}

}  // namespace

std::vector<ink::Tine> Painting::Hand::comb() {
    const std::size_t n = reservoir.n_bundles(), cells = reservoir.n_cells();
    std::vector<double> lies(n, 0);
    for (std::size_t i = 0; i < touched.size(); ++i) lies[i / cells] += static_cast<double>(touched[i]);
    const double firmest = *std::max_element(lies.begin(), lies.end());
    const double part = tines.empty() ? 1 : -std::expm1(-(travel - combed) / kSettling);
    tines.resize(n, 0);
    combed = travel;
    std::vector<ink::Tine> out;
    for (std::size_t k = 0; k < n; ++k) {
        tines[k] += part * ((firmest > 0 ? lies[k] / firmest : 0) - tines[k]);
        const double roll = fade(hash_bits(tuft.bundles.seed, 3000 + k), travel / kRolling);
        out.push_back({0.5 + 0.5 * turned * tuft.bundles.place[k].x, tines[k] * (0.4 + 0.6 * roll)});
    }
    return out;
}

double Painting::Hand::lay_paste(Stamp& stamp, double stress) {
    const double patch = footprint_area(stamp.footprint);
    footprint::round_edges(stamp.footprint, kShoulder * ink.film * ink::kFilmUnit);
    const ink::NodeAreas areas = stamper.expose(stamp);
    double area = 0;
    for (const double a : areas) area += a;
    const auto pressed = [stress](const double (&of)[2]) { return of[0] + of[1] * stress; };
    // Paste is pushed out beside the way, not before and behind.
    const double way = glm::length(stamp.motion.shift);
    const double beside = way > 0 ? std::abs(glm::dot(stamp.motion.shift, axis)) / way : 1;
    const double target = static_cast<double>(stamp.ink.target);
    ink::PasteParams params{.target = target,
                            .transfer_length = ink.transfer_length,
                            .capacity = static_cast<double>(stamp.ink.capacity),
                            .dig = pressed(kDig),
                            .exchange = -std::expm1(-stamp.ds / kMixing),
                            .room = area > 0 ? ink::room_left(reservoir, touched) / area : 0};
    params.comb = ink::comb_of(comb(), {.width = stamp.grid.step.y * (ink::kAcross - 1),
                                        .film = target * ink::kFilmUnit,
                                        .yield = ink.yield,
                                        .depth = pressed(kDepth),
                                        .rim = pressed(kRim) * beside * beside});
    const Stamper::Passed passed =
        stamper.plough(params, ink::mixes_within(reservoir, nodes, target, patch), stamp.ds);
    ink::spend(reservoir, passed.given, nodes);
    ink::absorb(reservoir, passed.taken, nodes, touched);
    double sum = 0;
    for (int node = 0; node < ink::kNodes; ++node)
        for (int p = 0; p < ink::Reservoir::kPlanes; ++p) sum += passed.given[node][p] - passed.taken[node][p];
    return sum;
}

}  // namespace tuft::stroke
