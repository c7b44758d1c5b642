#pragma once

#include "footprint/outline/picture.h"
#include "footprint/stamp/stamp.h"

/// \file
/// Quadrants of a tile that a stamp covers fully or not at all: the kernel evaluates only the others. Called by
/// `plan_stamp`.
///
/// Quadrants are the reason for tiles of 16 × 16 texels with small brushes too. A stamp 64 texels across on a
/// sphere reaches the clusters of 26 tiles, covers 3,440 texels and evaluates 4,310 in 8 × 8 squares. Tiles of 8 ×
/// 8 would evaluate the same squares (19 µs). The cluster search, 29 µs, grows with the number of clusters: 112 µs
/// for the 76 clusters of such tiles (measured one after the other, medians, with stamps of 64 and 128 texels on
/// tiles of 16, CPU time on a busy machine).
namespace tuft::footprint {

/// Bounds on the poses of a moving picture over a texel, besides the texel's position.
struct SweptDisplacement {
    Vec2f zero{0};        ///< cells, of the footprint's origin
    Vec2f half_shift{0};  ///< cells, half of the translation
    float turn = 0;       ///< radians, absolute
    float extra = 0;      ///< cells, difference between the two mappings
};

inline constexpr int kQuadrants = 4;

/// Adds a disc for each quadrant of a tile that contains all picture positions over it; `frame` maps the texels.
/// Adds none and returns false when the centres and corners of the quadrants are not all in this cluster.
bool add_quadrants(const ClusterFrame& frame, std::int32_t cluster, const atlas::TexelMap& texels, std::uint32_t slot,
                   const SweptDisplacement& displacement, Discs& discs);

/// Classifies the quadrants of a cluster as full, empty or partial, by their discs from `first` on.
void classify_quadrants(const Discs& discs, std::size_t first, ClusterFrame& frame);

}  // namespace tuft::footprint
