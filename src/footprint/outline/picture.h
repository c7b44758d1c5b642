#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/system/recycled.h"
#include "footprint/outline/footprint.h"

/// \file
/// The footprint's picture by columns, and the coverage of its blocks. Used by `footprint/stamp`.
namespace tuft::footprint {

/// Instruction sets of the kernels; all give the same bits.
enum class Isa : std::uint8_t { baseline, avx2, avx512 };
Isa best_isa();  ///< of this machine

/// Transposes the picture [width * height] to [height * width]. Cost: 0.1 ns a cell.
void transpose(std::span<const std::uint8_t> cells, int width, int height, Recycled<std::uint8_t>& turned);

/// What a block of cells holds.
enum class Cover : std::uint8_t { mixed, empty, full };

/// Discs in a picture, for a batch of coverage queries.
class Discs {
  public:
    void clear() { n_ = 0; }
    /// In cells; cell (0, 0) has its centre at 0.
    void add(const Vec2f& centre, float radius) {
        if (n_ == x_.size()) reserve_one();
        // Further ones lie in the outside anyway.
        const bool sound = std::abs(centre.x) < kFar && std::abs(centre.y) < kFar && radius < kFar;
        x_[n_] = sound ? centre.x : 0;
        y_[n_] = sound ? centre.y : 0;
        r_[n_++] = sound ? radius : kFar;
    }
    std::size_t size() const { return n_; }
    /// Returns the coverage of the cells in disc i, after `BlockTally::find_coverage`. May return mixed for a disc that
    /// is full or empty.
    Cover cover(std::size_t i) const;

  private:
    friend class BlockTally;
    static constexpr float kFar = 1e5f;  // cells
    void reserve_one();

    std::size_t n_ = 0;
    std::vector<float> x_, y_, r_;      // [n and more, a multiple of 16]
    std::vector<std::uint32_t> found_;  // blocks not full and, in the upper half, not empty
};

/// Counts of full and of empty blocks along the rows of blocks of a picture.
class BlockTally {
  public:
    static constexpr int kBlock = 4;  ///< cells along the side of a block

    /// Counts the blocks of a picture. Reuses the memory of the previous one.
    void count(const Footprint& footprint);

    /// Finds the coverage in each disc; outside the picture it is 0. Cost: 10 ns a disc.
    void find_coverage(Discs& discs, Isa isa) const;

  private:
    int width_ = 0, height_ = 0;            // blocks
    int cells_x_ = 0, cells_y_ = 0;         // whole cells
    std::vector<std::uint32_t> to_left_;    // [height (width + 1)] blocks to the left that are not
                                            // full, and in the upper half: not empty
    std::vector<std::uint32_t> all_, any_;  // [width] bits of the cells of a block
};

}  // namespace tuft::footprint
