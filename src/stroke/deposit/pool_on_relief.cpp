#include "stroke/deposit/pool_on_relief.h"

#include <algorithm>

#include "ink/texels/pool.h"
#include "ink/texels/relief.h"

namespace tuft::stroke {
namespace {

constexpr double kRidgeFilm = 0.35;  // of the film that is deposited

}  // namespace

void pool_on_relief(StampTarget& target, const ink::Ink& ink, const std::function<const atlas::SeamLinks&()>& seams) {
    if (!target.on_relief()) return;
    std::vector<const ink::TileSnapshot*> before;
    for (const auto& [slot, tile] : target.snapshots()) before.push_back(&tile);
    std::sort(before.begin(), before.end(), [](const auto* a, const auto* b) { return a->slot < b->slot; });
    ink::PoolOptions options{.ridge_film = kRidgeFilm * ink.film, .strength = ink.strength()};
    if (const MaskTexels* mask = target.mask())
        options.free = [mask](std::uint32_t slot, int texel) { return mask->coverage(slot, texel) > 0; };
    ink::pool(target.canvas(), target.texels(), seams(), before, options);
}

}  // namespace tuft::stroke
