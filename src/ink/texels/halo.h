#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "atlas/texels/seam_links.h"

/// \file
/// Tiles with a border of texels, for operations that cross tiles at the end of a stroke (level.h, pool.h).
/// Internal to `ink`.
namespace tuft::ink {

inline constexpr int kHaloRow = atlas::kTile + 2;
using Halo = std::array<float, kHaloRow * kHaloRow>;  ///< a tile with the texels round it, corners 0

/// Place of a texel of the tile, and of those round it: −1 to 16.
constexpr int halo_at(int column, int row) {
    return (row + 1) * kHaloRow + column + 1;
}

/// A tile of a list and where its neighbours are.
struct HaloTile {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 4> beside{};  ///< places in the list: left, right, below, above; kNone
    std::vector<std::pair<std::uint32_t, atlas::SeamLink>> links;  ///< place of the other end
};

/// The tiles of the slots, which ascend, with their neighbours and links among them.
template <class Tile>
std::vector<Tile> halo_tiles(const atlas::TexelMap& map, const atlas::SeamLinks& seams,
                             std::span<const std::uint32_t> slots) {
    const auto place_of = [&](std::uint32_t slot) {
        const auto found = std::lower_bound(slots.begin(), slots.end(), slot);
        return found != slots.end() && *found == slot ? static_cast<std::uint32_t>(found - slots.begin()) : kNone;
    };
    std::vector<Tile> tiles(slots.size());
    const auto n = static_cast<std::int64_t>(map.tiles_per_side);
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Tile& tile = tiles[i];
        tile.slot = slots[i];
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
    return tiles;
}

/// A field of the tiles, field(tile) [256], with what lies beside it.
template <class Tile, class Field>
void fill_halo(Halo& out, const std::vector<Tile>& tiles, const Tile& tile, Field field) {
    constexpr int kSide = atlas::kTile, kWide = kHaloRow;
    out.fill(0);
    const auto& here = field(tile);
    for (int y = 0; y < kSide; ++y) std::copy_n(here.data() + y * kSide, kSide, out.data() + (y + 1) * kWide + 1);
    for (int side = 0; side < 4; ++side) {
        if (tile.beside[side] == kNone) continue;
        const auto& from = field(tiles[tile.beside[side]]);
        for (int k = 0; k < kSide; ++k) {
            const int at[] = {(k + 1) * kWide, (k + 1) * kWide + kWide - 1, k + 1, (kWide - 1) * kWide + k + 1};
            const int of[] = {k * kSide + kSide - 1, k * kSide, (kSide - 1) * kSide + k, k};
            out[at[side]] = from[of[side]];
        }
    }
}

}  // namespace tuft::ink
