#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "atlas/atlas.h"
#include "core/files/shared_array.h"

/// \file
/// Map from texels to surface points: for each 16 × 16 tile of the atlas that a chart touches, position and normal
/// of every texel centre. All modules above store texel data by its slots.
namespace tuft::atlas {

inline constexpr int kTile = 16;  ///< texels along the side of a tile
inline constexpr int kTileTexels = kTile * kTile;
inline constexpr std::uint8_t kNoCluster = 255;

/// Area and cluster of the texels of one occupied tile, texel t = row * 16 + column. Texels outside every chart
/// have cluster == kNoCluster and zero area.
struct TexelTile {
    /// m² of surface of the texel; beside seams those of both charts share it (border_cells.h)
    alignas(64) std::array<float, kTileTexels> area;
    alignas(64) std::array<std::uint8_t, kTileTexels> cluster;  ///< index of the texel's cluster in this tile
};

/// Where the texels of one tile lie, structure of arrays. Texels outside every chart: anything.
struct TexelShape {
    alignas(64) std::array<float, kTileTexels> px, py, pz;  ///< metres, model frame
    alignas(64) std::array<float, kTileTexels> nx, ny, nz;  ///< unit normal
};

/// How positions and normals are kept.
enum class TexelStore : std::uint8_t {
    automatic,  ///< packed for atlases of 4096² texels and more
    floats,     ///< `TexelShape`: 29 bytes a texel with its area and cluster
    packed,     ///< `PackedShape`: 15 bytes, and 4e-4 texels less exact
};

/// What `automatic` means for an atlas of size × size texels.
inline bool is_packed(TexelStore store, std::uint32_t size) {
    return store == TexelStore::packed || (store == TexelStore::automatic && size >= 4096);
}

/// The same in 16-bit numbers: position = lo + step (x, y, z) in the box of the texel's cluster,
/// normal by the octahedral map [Cigolle2014]: (nu, nv) = 32767.5 (1 + (x, y)/(|x|+|y|+|z|)),
/// the lower half folded over the diagonals; within 6.5e-5 rad.
struct PackedShape {
    alignas(64) std::array<std::uint16_t, kTileTexels> x, y, z, nu, nv;
};

/// Box of the packed positions of a cluster.
struct PackedBox {
    Vec3f lo{0};     ///< metres, lower corner
    float step = 0;  ///< metres, of a packed number
};

/// Occupied tiles ("slots") of an atlas in row-major tile order. Everything that is
/// stored per texel elsewhere (ink, wetness) is stored per slot in this order.
struct TexelMap {
    std::uint32_t size = 0;                   ///< texels per side of the atlas
    std::uint32_t tiles_per_side = 0;         ///< ceil(size / 16)
    double texel_size = 0;                    ///< metres, mean
    std::vector<std::uint32_t> slot_of_tile;  ///< [tiles_per_side²] slot or kNone
    std::vector<std::uint32_t> tile_of_slot;  ///< [n_slots] tile index = ty * tiles_per_side + tx
    SharedArray<TexelTile> tiles;             ///< [n_slots]
    std::vector<TexelShape> shapes;           ///< [n_slots], or empty when packed
    SharedArray<PackedShape> packed;          ///< [n_slots], or empty
    std::vector<PackedBox> boxes;             ///< [n_clusters] when packed
    /// [n_slots] metres: neighbouring texels further apart than this are not connected on the surface.
    std::vector<float> reach;
    std::vector<std::uint32_t> cluster_start;  ///< [n_slots + 1] clusters, counted slot by slot
    std::vector<std::uint32_t> cluster_chart;  ///< [n_clusters]

    std::size_t n_slots() const { return tiles.size(); }
    /// Return position (metres) and unit normal of a texel's centre, also of a packed map.
    Vec3f position(std::uint32_t slot, int texel) const;
    Vec3f normal(std::uint32_t slot, int texel) const;
};

/// Positions and normals of a tile: the map's own, or unpacked into the given buffer. About 0.1 µs
/// when packed.
const TexelShape& shape_of(const TexelMap& map, std::uint32_t slot, TexelShape& buffer);

/// Packs a tile whose clusters are known; `boxes` [n_clusters of the tile] are made to fit.
PackedShape pack_shape(const TexelShape& shape, const TexelTile& tile, std::span<PackedBox> boxes);

/// A texel of the map.
struct TexelRef {
    std::uint32_t slot = kNone;  ///< kNone: no texel
    std::uint8_t texel = 0;      ///< row * 16 + column of the tile

    bool valid() const { return slot != kNone; }
    bool operator==(const TexelRef&) const = default;
};

/// Column and row of a texel in the atlas.
struct TexelPlace {
    std::int64_t x = 0, y = 0;
};

/// Returns the place of texel `texel` (row · 16 + column of the tile) of a slot. `texel_ref` is its inverse.
inline TexelPlace texel_place(const TexelMap& map, std::uint32_t slot, std::uint32_t texel) {
    const std::uint32_t tile = map.tile_of_slot[slot];
    return {std::int64_t{tile % map.tiles_per_side} * kTile + texel % kTile,
            std::int64_t{tile / map.tiles_per_side} * kTile + texel / kTile};
}

/// The texel in column x and row y of the atlas; not valid where no chart covers it.
inline TexelRef texel_ref(const TexelMap& map, std::int64_t x, std::int64_t y) {
    if (x < 0 || y < 0 || x >= map.size || y >= map.size) return {};
    const std::uint32_t slot = map.slot_of_tile[(y / kTile) * map.tiles_per_side + x / kTile];
    const auto texel = static_cast<std::uint8_t>((y % kTile) * kTile + x % kTile);
    if (slot == kNone || map.tiles[slot].cluster[texel] == kNoCluster) return {};
    return {slot, texel};
}

/// Builds the map. A texel is covered when its centre lies in a triangle of the atlas (corners snapped to 1/4096
/// texel). A centre on a shared edge belongs to one side; where triangles overlap, to the lowest index. A cluster
/// is the set of connected texels of the same chart and tile with normals within 35° of the first. Where normals of
/// the tile deviate more than 30° from their mean, clusters are limited to quadrants of it. Tiles and clusters do
/// not depend on `store`, nor do areas, except by a thousandth beside seams. The same bits for any number of
/// threads. Cost: about 1 s at 4096² on two threads, memory for occupied tiles only.
TexelMap build_texel_map(const mesh::TriangleMesh& mesh, const Atlas& atlas, const ProgressFn& progress = {},
                         TexelStore store = TexelStore::automatic);

/// A covered texel, the triangle its centre lies in, and the weights of that triangle's corners there.
using TexelVisit = std::function<void(std::uint32_t slot, int texel, std::uint32_t triangle, const Vec3& weights)>;

/// Calls `visit` once for every covered texel of the map, which must be of this atlas; from several threads, each
/// with slots of its own.
void visit_texels(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, const TexelVisit& visit);

}  // namespace tuft::atlas
