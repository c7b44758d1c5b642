#pragma once

#include <cstdint>
#include <vector>

#include "footprint/footprint.h"

/// The footprint's picture made ready for the kernel, and what is known of its parts.
namespace tuft::footprint {

/// Packs every two cells one above the other into a word, the lower one in its low byte:
/// [(height - 1) width]. Two neighbouring words hold the four corners of a square.
void pack_picture(const Footprint& footprint, std::vector<std::uint16_t>& pairs);

enum class Cover : std::uint8_t { mixed, empty, full };

/// Which blocks of a picture are fully covered and which are empty, counted along the rows
/// of blocks.
class BlockTally {
  public:
    static constexpr int kBlock = 4;  ///< cells along the side of a block

    /// Takes the picture over; the memory of an earlier one is used again.
    void count(const Footprint& footprint);

    /// Coverage of the cells within `radius` of `centre` (cells; cell (0, 0) has its centre at
    /// 0). Outside the picture there is none. May say mixed where it is not.
    Cover look(const Vec2f& centre, float radius) const;

  private:
    int width_ = 0, height_ = 0;              // blocks
    int cells_x_ = 0, cells_y_ = 0;           // whole cells
    std::vector<std::uint16_t> not_full_;     // [height (width + 1)] blocks to the left
    std::vector<std::uint16_t> not_empty_;    // likewise
    std::vector<std::uint32_t> all_, any_;    // [width] bits of the cells of a block
};

}  // namespace tuft::footprint
