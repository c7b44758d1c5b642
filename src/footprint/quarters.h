#pragma once

#include "footprint/picture.h"
#include "footprint/stamp.h"

/// Which quarters of a tile a stamp covers wholly, and which not at all: the kernel works on the
/// others only.
namespace tuft::footprint {

/// Where a picture may be over a texel, besides its place: the poses of a moving stamp.
struct Drift {
    Vec2f zero{0};      ///< cells, of the footprint's origin
    Vec2f half_way{0};  ///< cells
    float turn = 0;     ///< radians, absolute
    float extra = 0;    ///< cells, by which another way of mapping may be off
};

inline constexpr int kQuarters = 4;

/// Adds a disc for each quarter of a tile with all that the picture may have over it, where `frame` maps
/// the texels. False, and none, where the quarters' middles and corners are not all of this piece.
bool add_quarters(const PieceFrame& frame, std::uint8_t piece, const atlas::TexelMap& texels, std::uint32_t slot,
                  const Drift& drift, Discs& discs);

/// Sorts the quarters of a piece into full ones, empty ones and the rest by their discs from `first` on.
void sort_quarters(const Discs& discs, std::size_t first, PieceFrame& frame);

}  // namespace tuft::footprint
