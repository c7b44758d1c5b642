#pragma once

#include "footprint/outline/picture.h"
#include "footprint/stamp/stamp.h"

/// Which quadrants of a tile a stamp covers wholly, and which not at all: the kernel works on the
/// others only.
///
/// They are why tiles stay 16 × 16 texels for small brushes too. A stamp 64 texels across on a sphere
/// reaches 26 tiles' clusters, covers 3,440 texels and evaluates 4,310 in 8 × 8 squares; tiles of 8 × 8
/// would evaluate the same squares (19 µs), but the walk over the clusters, 29 µs, grows with their
/// number: 112 µs for the 76 clusters that there would be (measured one after the other, medians, with
/// stamps of 64 and 128 texels on tiles of 16, CPU time on a busy machine).
namespace tuft::footprint {

/// Where a picture may be over a texel, besides its place: the poses of a moving stamp.
struct SweptDisplacement {
    Vec2f zero{0};      ///< cells, of the footprint's origin
    Vec2f half_way{0};  ///< cells
    float turn = 0;     ///< radians, absolute
    float extra = 0;    ///< cells, by which another way of mapping may be off
};

inline constexpr int kQuadrants = 4;

/// Adds a disc for each quadrant of a tile with all that the picture may have over it, where `frame` maps
/// the texels. False, and none, where the quadrants' middles and corners are not all of this cluster.
bool add_quadrants(const ClusterFrame& frame, std::int32_t cluster, const atlas::TexelMap& texels, std::uint32_t slot,
                   const SweptDisplacement& drift, Discs& discs);

/// Sorts the quadrants of a cluster into full ones, empty ones and the rest by their discs from `first` on.
void sort_quadrants(const Discs& discs, std::size_t first, ClusterFrame& frame);

}  // namespace tuft::footprint
