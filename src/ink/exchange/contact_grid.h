#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "atlas/texels/texel_map.h"
#include "core/geometry/types.h"

/// Where on the contact patch a texel lies: what its ink depends on.
namespace tuft::ink {

/// Nodes over the contact patch, `kAlong` from the root's side to the tip's, `kAcross` over its
/// width; node (i, j) has the index i * kAcross + j. Between them ink is interpolated by hats.
inline constexpr int kAlong = 4, kAcross = 8, kNodes = kAlong * kAcross;
using NodeAreas = std::array<double, kNodes>;  ///< m² of surface by hats

/// Lays the nodes over a patch in the stamp's (u, v), metres: p = (axis · d, axis × d) lies at the
/// node coordinates (p − lo) / step; beyond the outer nodes as on them.
struct ContactGrid {
    Vec2 axis{1, 0};  ///< unit, from the root's side to the tip's
    Vec2 lo{0};       ///< metres along and across the axis, of node (0, 0)
    Vec2 step{1};     ///< metres between nodes, > 0

    /// Node coordinates (along, across) of a place, not limited to the nodes.
    Vec2 at(const Vec2& d) const { return (Vec2{glm::dot(axis, d), axis.x * d.y - axis.y * d.x} - lo) / step; }
};

/// The grid that spans these places along `axis`; of no places, that about the origin.
ContactGrid make_contact_grid(std::span<const Vec2> places, const Vec2& axis);

/// Node coordinates of the texels of a tile, limited to the nodes.
struct TexelPlaces {
    alignas(64) std::array<float, atlas::kTileTexels> along, across;
};

/// The same from the surface points, seen along the normal of the stamp's frame.
void place_texels(TexelPlaces& out, const ContactGrid& grid, const Frame& frame, const atlas::TexelShape& shape);

/// A figure across the contact patch, over its mean: finer than the nodes, as its bundles of hair are. Value i lies at
/// i / (kFirmnessSamples − 1) of the width.
inline constexpr int kFirmnessSamples = 129;
using FurrowDepths = std::array<float, kFirmnessSamples>;

/// The furrows at the texels of a tile, linear between its values.
void furrow_depth_at(std::span<float, atlas::kTileTexels> out, const TexelPlaces& places, const FurrowDepths& furrows);

/// The hats of the nodes that reach a tile's covered texels: w = ⟨1 − |i − along|⟩ ⟨1 − |j − across|⟩,
/// which sum to one on each; zero on uncovered ones.
struct HatBasis {
    int count = 0;
    std::array<std::uint8_t, kNodes> node;                                         ///< [count] ascending
    alignas(64) std::array<std::array<float, atlas::kTileTexels>, kNodes> weight;  ///< [count]
};

/// About 10 ns for each node that reaches the tile.
void hat_basis(HatBasis& out, const TexelPlaces& places, std::span<const float, atlas::kTileTexels> coverage);

/// Σ w · x · area over a tile for each of the hats, in an order of its own; x may be null: 1. Float sums.
void integrate_hats(std::span<double, kNodes> out, const HatBasis& hats, const float* x,
                    std::span<const float, atlas::kTileTexels> area);

/// Σ (after − before) · area over a tile, in an order of its own. Double sums.
double change_sum(const float* after, const float* before, const float* area);

/// out = Σ over the hats of weight · value, `values` by node.
void interpolate(std::array<float, atlas::kTileTexels>& out, const HatBasis& hats,
                 const std::array<float, kNodes>& values);

}  // namespace tuft::ink
