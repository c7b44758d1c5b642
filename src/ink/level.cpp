#include "ink/level.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "ink/paste.h"
#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kSide = atlas::kTile, kN = atlas::kTileTexels, kWide = kSide + 2;
constexpr double kStep = 0.2;  // of what two neighbours differ by, at most
constexpr int kMostSteps = 64;

using Texels = std::array<float, kN>;
using Halo = std::array<float, kWide * kWide>;  ///< a tile with the texels round it

struct Tile {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 4> beside;  ///< places in the list: left, right, below, above; kNone
    std::vector<std::pair<std::uint32_t, atlas::SeamLink>> links;  ///< place of the other end
    alignas(64) Texels area;              ///< m² of texels that take part; else 0
    alignas(64) Halo reach;               ///< the same with those round it
    alignas(64) Texels now, next;         ///< of the pigment in work
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

/// A field of the tiles with what lies beside it.
template <class Field>
void fill_halo(Halo& out, const std::vector<Tile>& tiles, const Tile& tile, Field field) {
    out.fill(0);
    const Texels& here = field(tile);
    for (int y = 0; y < kSide; ++y) std::copy_n(here.data() + y * kSide, kSide, out.data() + (y + 1) * kWide + 1);
    for (int side = 0; side < 4; ++side) {
        if (tile.beside[side] == kNone) continue;
        const Texels& from = field(tiles[tile.beside[side]]);
        for (int k = 0; k < kSide; ++k) {
            const int at[] = {(k + 1) * kWide, (k + 1) * kWide + kWide - 1, k + 1, (kWide - 1) * kWide + k + 1};
            const int of[] = {k * kSide + kSide - 1, k * kSide, (kSide - 1) * kSide + k, k};
            out[at[side]] = from[of[side]];
        }
    }
}

std::vector<Tile> tiles_of(const Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
                           const OpenBefore& before) {
    std::vector<std::uint32_t> slots;
    for (const auto& [slot, plane] : before) slots.push_back(slot);
    std::sort(slots.begin(), slots.end());
    const auto place_of = [&](std::uint32_t slot) {
        const auto found = std::lower_bound(slots.begin(), slots.end(), slot);
        return found != slots.end() && *found == slot ? static_cast<std::uint32_t>(found - slots.begin()) : kNone;
    };
    std::vector<Tile> tiles(slots.size());
    const auto n = static_cast<std::int64_t>(map.tiles_per_side);
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Tile& tile = tiles[i];
        tile.slot = slots[i];
        const Plane now = open_pigment(canvas, tile.slot);
        const Plane& was = *before.at(tile.slot);
        for (int t = 0; t < kN; ++t)
            tile.area[t] = now[t] > 0 && now[t] != was[t] ? map.tiles[tile.slot].area[t] : 0;
        const std::int64_t x = map.tile_of_slot[tile.slot] % n, y = map.tile_of_slot[tile.slot] / n;
        const std::int64_t beside[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
        for (int side = 0; side < 4; ++side) {
            const auto [bx, by] = beside[side];
            const bool in = bx >= 0 && by >= 0 && bx < n && by < n;
            const std::uint32_t slot = in ? map.slot_of_tile[static_cast<std::size_t>(by * n + bx)] : kNone;
            tile.beside[side] = slot == kNone ? kNone : place_of(slot);
        }
        for (std::uint32_t k = seams.start[tile.slot]; k < seams.start[tile.slot + 1]; ++k)
            if (const std::uint32_t other = place_of(seams.links[k].other_slot); other != kNone)
                tile.links.emplace_back(other, seams.links[k]);
    }
    for (Tile& tile : tiles) fill_halo(tile.reach, tiles, tile, [](const Tile& t) -> const Texels& { return t.area; });
    return tiles;
}

}  // namespace

void level_paste(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
                 const OpenBefore& before, double length) {
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
            if (const Plane* w = canvas.plane(tile.slot, p)) tile.now = *w;
            else tile.now.fill(0);
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
            if (canvas.plane(tile.slot, p) || std::any_of(tile.now.begin(), tile.now.end(), [](float v) { return v > 0; }))
                static_cast<Texels&>(canvas.touch(tile.slot, p)) = tile.now;
        });
    }
}

}  // namespace tuft::ink
