#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/atlas.h"

/// From texels to surface points: for each 16 × 16 tile of the atlas that a chart
/// touches, the position and normal of every texel centre.
namespace tuft::atlas {

inline constexpr int kTile = 16;                    ///< texels along the side of a tile
inline constexpr int kTileTexels = kTile * kTile;
inline constexpr std::uint8_t kNoPiece = 255;

/// One occupied tile, structure of arrays, texel t = row * 16 + column.
/// Texels outside every chart have piece == kNoPiece and zero area.
struct TexelTile {
    alignas(64) std::array<float, kTileTexels> px, py, pz;  ///< metres, model frame
    alignas(64) std::array<float, kTileTexels> nx, ny, nz;  ///< unit normal
    alignas(64) std::array<float, kTileTexels> area;        ///< m² of surface the texel stands for
    alignas(64) std::array<std::uint8_t, kTileTexels> piece;///< index of the texel's piece in this tile
};

/// Occupied tiles ("slots") of an atlas in row-major tile order. Everything that is
/// stored per texel elsewhere (ink, wetness) is stored per slot in this order.
struct TexelMap {
    std::uint32_t size = 0;            ///< texels per side of the atlas
    std::uint32_t tiles_per_side = 0;  ///< ceil(size / 16)
    double texel_size = 0;             ///< metres, mean
    std::vector<std::uint32_t> slot_of_tile;  ///< [tiles_per_side²] slot or kNone
    std::vector<std::uint32_t> tile_of_slot;  ///< [n_slots] tile index = ty * tiles_per_side + tx
    std::vector<TexelTile> tiles;             ///< [n_slots]

    std::size_t n_slots() const { return tiles.size(); }
};

/// Builds the map; about 1 s at 4096² on two threads.
TexelMap build_texel_map(const mesh::TriangleMesh& mesh, const Atlas& atlas,
                         const ProgressFn& progress = {});

}  // namespace tuft::atlas
