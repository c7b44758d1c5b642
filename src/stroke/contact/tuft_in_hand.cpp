#include "stroke/contact/tuft_in_hand.h"

#include <algorithm>
#include <cmath>

#include "brush/tuft/bundles.h"
#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/stir.h"

namespace tuft::stroke {
namespace {

// Bending moment of a firm press over B0/L: what a hand reaches at the working depth.
constexpr double kFirmPress = 0.1;
// Part of its volume that a sponge loses to a firm press.
constexpr double kFirmStrain = 0.25;

}  // namespace

namespace {

double wetness_at(double fullness) {
    const double x = std::clamp(fullness / kWetFullness, 0.0, 1.0);
    return x * (2 - x);
}

}  // namespace

double wetness_of(const ink::Reservoir& reservoir) {
    return wetness_at(reservoir.fullness());
}

ink::Reservoir empty_reservoir(const brush::Tuft& tuft) {
    brush::HairCells cells = brush::hair_cells(tuft.preset);
    return ink::make_reservoir(tuft.preset.capacity * 1e6, {.bundles = tuft.bundles.place,
                                                            .cell_ends = std::move(cells.ends),
                                                            .cell_capacities = std::move(cells.capacities)});
}

void TuftInHand::update_wetness() {
    brush.tuft.ink_left = brush.reservoir.fullness();
    brush.tuft.wetness = wetness_at(brush.tuft.ink_left);
}

void TuftInHand::bend(brush::TuftState next, const brush::Pose& pose) {
    ink::Reservoir& reservoir = brush.reservoir;
    if (!state.branches.empty() && !next.branches.empty() && ink::is_mixed(reservoir)) {
        const Recycled<brush::Section>& before = state.branches[0].sections;
        const Recycled<brush::Section>& after = next.branches[0].sections;
        const Quat turn = pose.rotation * glm::inverse(rotation);
        const std::size_t cells = reservoir.n_cells();
        std::vector<Vec2> bent(cells, Vec2{0});
        for (std::size_t c = 0; c < cells && before.size() == after.size() && !after.empty(); ++c) {
            const double begin = c ? reservoir.layout.cell_ends[c - 1] : 0;
            const double from_root = 0.5 * (begin + reservoir.layout.cell_ends[c]);
            const auto i = static_cast<std::size_t>((1 - from_root) * static_cast<double>(after.size() - 1) + 0.5);
            const Vec3 change = after[i].tangent - turn * before[i].tangent;
            bent[c] = {glm::dot(change, after[i].e), glm::dot(change, after[i].m)};
        }
        ink::stir(reservoir, bent, preset().radius);
    }
    state = std::move(next);
    if (brush::is_foam(preset())) ink::compress(reservoir, 1 - state.volume_lost / std::max(preset().capacity, 1e-12));
    rotation = pose.rotation;
}

double TuftInHand::stress() const {
    if (brush::is_foam(preset())) {
        const double volume = preset().capacity / (1 - preset().solid);
        return std::min(1.0, state.volume_lost / std::max(kFirmStrain * volume, 1e-12));
    }
    const double firm = kFirmPress * preset().stiffness / preset().length;
    return std::min(1.0, std::abs(state.root_moment) / firm);
}

ink::Drain TuftInHand::drain(const brush::Pose& pose, const Vec3& contact, const Vec3& down) const {
    const Vec3 hangs = contact - pose.position;
    const double weight = glm::length(down) * glm::length(hangs);
    // All of it from a tuft that hangs, half from a level one, whose underside it runs along.
    return {.length = preset().length,
            .radius = preset().radius,
            .slope = weight > 0 ? 0.5 + 0.5 * glm::dot(hangs, down) / weight : 0};
}

}  // namespace tuft::stroke
