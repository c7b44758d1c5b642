#include "ink/exchange/stir.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink {
namespace {

constexpr double kStirring = 3e-3;  // metres of slip after which bundles have shared what lies between them

}  // namespace

void stir(Reservoir& tuft, std::span<const Vec2> turned, double radius) {
    const std::size_t cells = tuft.n_cells();
    if (turned.size() != cells) return;
    for (const CellLink& link : tuft.links) {
        const std::size_t i = link.a / cells, j = link.b / cells;
        if (i == j) continue;
        const Vec2 apart = radius * (tuft.layout.bundles[j] - tuft.layout.bundles[i]);
        const double slip = std::abs(glm::dot(apart, turned[link.a % cells]));
        Reservoir::Content &a = tuft.content[link.a], &b = tuft.content[link.b];
        const double qa = sum_of(a), qb = sum_of(b);
        const double moved = -0.5 * std::expm1(-slip / kStirring) * std::min(qa, qb);
        if (!(moved > 0)) continue;
        for (int p = 0; p < Reservoir::kPlanes; ++p) {
            const double over = moved / qa * a[p] - moved / qb * b[p];
            a[p] -= over;
            b[p] += over;
        }
    }
}

}  // namespace tuft::ink
