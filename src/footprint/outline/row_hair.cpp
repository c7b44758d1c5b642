#include <algorithm>
#include <cmath>

#include "core/ease.h"
#include "footprint/outline/cuts.h"

// Hair between the spines of a row.
namespace tuft::footprint {
namespace {

constexpr double kMostSpread = 3;    // times its width, that a strip is spread to one side
constexpr double kGives = 0.3;       // of it, up to which hair that touches its neighbours is not spread wholly
constexpr double kAlongBroad = 0.7;  // cosine from a section's wide axis to its broad side from which they are one

/// Half the broad side of a section of a strip, metres, on the surface.
Vec2 broad_half(const Cut& cut) {
    return Trail::kStripChord * Vec2(cut.broad());
}

/// Factors on both halves of a section, towards its broad axis and against it.
struct Spread {
    double plus = 1, minus = 1;

    /// Takes the half that faces a neighbour as far as midway to it.
    void reach(const Cut& own, const Cut& beside) {
        const Vec2 half = broad_half(own), to = 0.5 * (beside.centre - own.centre);
        const double size = glm::dot(half, half);
        if (!(size > 1e-12)) return;
        const double part = glm::dot(to, half) / size;
        double& factor = part > 0 ? plus : minus;
        const double beyond = std::min(std::abs(part), kMostSpread) - 1;
        factor = std::max(factor, 1 + beyond * smooth_step(beyond / kGives));
    }
};

void spread_section(Cut& cut, const Spread& spread) {
    if (std::abs(cut.turn.x) < kAlongBroad) return;  // it stands on its edge
    const double wider = 0.5 * (spread.plus + spread.minus);
    cut.centre += 0.5 * (spread.plus - spread.minus) * broad_half(cut);
    cut.a *= wider;
    cut.b /= wider;
}

}  // namespace

void fill_rows(Recycled<Trail>& trails) {
    Recycled<Recycled<Spread>> spread;
    for (const Trail& trail : trails) spread.emplace_back(trail.cuts.size());
    for (std::size_t k = 0; k < trails.size(); ++k)
        for (std::size_t l = 0; l < trails.size(); ++l) {
            const auto& openings = trails[k].openings;
            const bool beside = std::any_of(openings.begin(), openings.end(), [&](const TrailOpening& opening) {
                return opening.branch == trails[l].branch;
            });
            if (!beside || !trails[k].strip || trails[k].cuts.size() != trails[l].cuts.size()) continue;
            for (std::size_t i = 0; i < trails[k].cuts.size(); ++i) {
                spread[k][i].reach(trails[k].cuts[i], trails[l].cuts[i]);
                spread[l][i].reach(trails[l].cuts[i], trails[k].cuts[i]);
            }
        }
    for (std::size_t k = 0; k < trails.size(); ++k)
        for (std::size_t i = 0; i < trails[k].cuts.size(); ++i) spread_section(trails[k].cuts[i], spread[k][i]);
}

}  // namespace tuft::footprint
