#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "atlas/texels/texel_map.h"
#include "core/geometry/types.h"

/// \file
/// Grid of nodes over the contact patch. Ink exchange varies over the patch by its nodes; hat functions interpolate
/// between them. Used by all of `ink/exchange`.
namespace tuft::ink {

/// Nodes over the contact patch, `kAlong` from the root's side to the tip's, `kAcross` over its
/// width; node (i, j) has the index i * kAcross + j. Between them ink is interpolated by hats.
inline constexpr int kAlong = 4, kAcross = 8, kNodes = kAlong * kAcross;
using NodeAreas = std::array<double, kNodes>;  ///< m² of surface by hats

/// Places the nodes on a patch in the stamp's (u, v), metres: p = (axis · d, axis × d) has the node coordinates (p
/// − lo) / step, clamped to the outer nodes.
struct ContactGrid {
    Vec2 axis{1, 0};  ///< unit, from the root's side to the tip's
    Vec2 lo{0};       ///< metres along and across the axis, of node (0, 0)
    Vec2 step{1};     ///< metres between nodes, > 0

    /// Node coordinates (along, across) of a place, not limited to the nodes.
    Vec2 at(const Vec2& d) const { return (Vec2{glm::dot(axis, d), axis.x * d.y - axis.y * d.x} - lo) / step; }
};

/// Returns the grid that spans `places` along `axis`; for no places, one about the origin.
ContactGrid make_contact_grid(std::span<const Vec2> places, const Vec2& axis);

/// Node coordinates of the texels of a tile, limited to the nodes.
struct TexelPlaces {
    alignas(64) std::array<float, atlas::kTileTexels> along, across;
};

/// Computes the node coordinates of a tile's texels from their surface points, projected along the normal of the
/// stamp's frame.
void place_texels(TexelPlaces& out, const ContactGrid& grid, const Frame& frame, const atlas::TexelShape& shape);

/// A profile across the contact patch, relative to its mean; finer than the nodes, since it resolves bundles. Value
/// i lies at i / (kFirmnessSamples − 1) of the width.
inline constexpr int kFirmnessSamples = 129;
using FurrowDepths = std::array<float, kFirmnessSamples>;

/// Interpolates the furrow profile linearly at the texels of a tile.
void furrow_depth_at(std::span<float, atlas::kTileTexels> out, const TexelPlaces& places, const FurrowDepths& furrows);

/// Hat functions of the nodes that reach a tile's covered texels: w = ⟨1 − |i − along|⟩ ⟨1 − |j − across|⟩. They
/// sum to one on each covered texel and are 0 on uncovered ones.
struct HatBasis {
    int count = 0;
    std::array<std::uint8_t, kNodes> node;                                         ///< [count] ascending
    alignas(64) std::array<std::array<float, atlas::kTileTexels>, kNodes> weight;  ///< [count]
};

/// About 10 ns for each node that reaches the tile.
void hat_basis(HatBasis& out, const TexelPlaces& places, std::span<const float, atlas::kTileTexels> coverage);

/// Computes Σ w · x · area over a tile for each hat; x may be null: 1. Fixed order, float sums.
void integrate_hats(std::span<double, kNodes> out, const HatBasis& hats, const float* x,
                    std::span<const float, atlas::kTileTexels> area);

/// Returns Σ (after − before) · area over a tile. Fixed order, double sums.
double change_sum(const float* after, const float* before, const float* area);

/// out = Σ over the hats of weight · value, `values` by node.
void interpolate(std::array<float, atlas::kTileTexels>& out, const HatBasis& hats,
                 const std::array<float, kNodes>& values);

}  // namespace tuft::ink
