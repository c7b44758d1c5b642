#include "ink/film/level.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "core/system/parallel.h"
#include "ink/film/tile/paste.h"
#include "ink/texels/halo.h"

namespace tuft::ink {
namespace {

constexpr int kSide = atlas::kTile, kN = atlas::kTileTexels, kWide = kHaloRow;
constexpr double kStep = 0.2;  // of what two neighbours differ by, at most
constexpr int kMostSteps = 64;

using Texels = std::array<float, kN>;

struct Tile : HaloTile {
    alignas(64) Texels area;       ///< m² of texels that take part; else 0
    alignas(64) Halo reach;        ///< the same with those round it
    alignas(64) Texels now, next;  ///< of the pigment in work
};

/// next = now + part Σ min(areas) (neighbour − now) / area.
TUFT_CLONES void step(float* __restrict next, const float* __restrict now, const float* __restrict reach,
                      const float* __restrict area, float part) {
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int i = (y + 1) * kWide + x + 1;
            const float here = now[i], a = reach[i];
            const auto flux = [&](int other) {
                const float g = reach[other] < a ? reach[other] : a;
                return g * (now[other] - here);
            };
            const float sum = (flux(i - 1) + flux(i + 1)) + (flux(i - kWide) + flux(i + kWide));
            const int t = y * kSide + x;
            next[t] = here + (area[t] > 0 ? part * sum / area[t] : 0);
        }
}

std::vector<Tile> tiles_of(const Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
                           const OpenBefore& before) {
    std::vector<std::uint32_t> slots;
    slots.reserve(before.size());
    for (const auto& [slot, plane] : before) slots.push_back(slot);
    std::sort(slots.begin(), slots.end());
    std::vector<Tile> tiles = halo_tiles<Tile>(map, seams, slots);
    for (Tile& tile : tiles) {
        const Plane now = open_pigment(canvas, tile.slot);
        const Plane& was = *before.at(tile.slot);
        for (int t = 0; t < kN; ++t) tile.area[t] = now[t] > 0 && now[t] != was[t] ? map.tiles[tile.slot].area[t] : 0;
    }
    for (Tile& tile : tiles) fill_halo(tile.reach, tiles, tile, [](const Tile& t) -> const Texels& { return t.area; });
    return tiles;
}

}  // namespace

void level_paste(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const OpenBefore& before,
                 double length) {
    const double spread = length * length / (2 * map.texel_size * map.texel_size);  // steps times part
    const int steps = std::min(static_cast<int>(std::ceil(spread / kStep)), kMostSteps);
    if (steps < 1 || before.empty()) return;
    const auto part = static_cast<float>(std::min(spread / steps, kStep));
    std::vector<Tile> tiles = tiles_of(canvas, map, seams, before);
    const auto each_tile = [&](auto act) {
        parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) act(tiles[i]);
        });
    };
    for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p) {
        each_tile([&](Tile& tile) {
            if (const Plane* w = canvas.plane(tile.slot, p))
                tile.now = *w;
            else
                tile.now.fill(0);
        });
        for (int k = 0; k < steps; ++k) {
            each_tile([&](Tile& tile) {
                alignas(64) Halo now;
                fill_halo(now, tiles, tile, [](const Tile& t) -> const Texels& { return t.now; });
                step(tile.next.data(), now.data(), tile.reach.data(), tile.area.data(), part);
                for (const auto& [place, link] : tile.links) {
                    const Tile& other = tiles[place];
                    const float a = tile.area[link.texel], b = other.area[link.other_texel];
                    if (!(a > 0 && b > 0)) continue;
                    const float through = part * std::min(link.weight, 1.0f) * std::min(a, b);
                    tile.next[link.texel] += through * (other.now[link.other_texel] - tile.now[link.texel]) / a;
                }
            });
            each_tile([](Tile& tile) { tile.now = tile.next; });
        }
        each_tile([&](Tile& tile) {
            if (canvas.plane(tile.slot, p) ||
                std::any_of(tile.now.begin(), tile.now.end(), [](float v) { return v > 0; }))
                static_cast<Texels&>(canvas.touch(tile.slot, p)) = tile.now;
        });
    }
}

}  // namespace tuft::ink
