#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "atlas/pack/pack_mask.h"

/// \file
/// Strip of occupied cells into which masks are placed: charts by the packer, pieces of film by decal/nest.h.
namespace tuft::atlas {

/// Returns how many cells stay free on both sides of a taken one, by distance in rows from 0 on, so that everything
/// else is at least `gap` cells away. Cells dx and dy apart have √(max(dx − 1, 0)² + max(dy − 1, 0)²) between them.
std::vector<int> reach_by_row(double gap);

/// A strip of cells, open upwards. Level k of a row stores whether any of the 2^k cells from x on is occupied: a
/// run of any length is tested at 64 positions with two words. Levels are built on demand.
class Strip {
  public:
    /// `reach`: see `reach_by_row`. `width` in cells.
    Strip(std::uint32_t width, std::vector<int> reach);

    struct Spot {
        std::uint32_t x = 0, y = kNone;  ///< y is kNone where there is no place
    };
    /// The lowest place, from row `from_row` on, where the mask ends below row `limit`;
    /// the leftmost of that row.
    Spot find(const Mask& mask, std::uint32_t from_row, std::uint32_t limit);
    void place(const Mask& mask, const Spot& spot);
    std::uint32_t top() const { return top_; }
    /// As it was when it was made.
    void clear() { n_rows_ = top_ = 0; }

  private:
    std::uint64_t* level(std::uint32_t y, int k) {
        return rows_.data() +
               (std::size_t{y} * static_cast<std::size_t>(levels_) + static_cast<std::size_t>(k)) * stride_;
    }
    void grow(std::uint32_t rows);
    void take(std::uint32_t y, std::int64_t first, std::int64_t last);
    const std::uint64_t* built_level(std::uint32_t y, int k) {
        if (built_[y] <= k) build_level(y, k);
        return level(y, k);
    }
    void build_level(std::uint32_t y, int k);
    /// Whether a row has as many free cells beside each other.
    bool has_gap(std::uint32_t y, std::uint32_t cells) {
        if (y >= n_rows_) return true;
        if (gap_[y] == kNone) measure_gap(y);
        return gap_[y] >= cells;
    }
    void measure_gap(std::uint32_t y);
    /// `valid`: buffer for the positions of a row, an array or a span.
    template <class Words>
    Spot find_among(const Mask& mask, std::uint32_t from_row, std::uint32_t limit, Words valid);
    /// Clears the places where the run hits something; false when none is left.
    template <class Words>
    bool block(const Run& run, std::uint32_t y, Words& valid);

    std::uint32_t width_;
    std::size_t words_, stride_;  // that hold cells; in all
    std::vector<int> reach_;
    int levels_ = 0;
    std::uint32_t n_rows_ = 0, top_ = 0;
    std::vector<std::uint64_t> rows_;
    std::vector<std::uint8_t> built_;    // per row: levels that are as level 0 says
    std::vector<std::uint32_t> gap_;     // per row: most free cells beside each other; kNone: not known
    std::vector<std::uint64_t> beyond_;  // the row's cells beyond the right edge
    std::vector<std::uint64_t> valid_;   // kept from `find` to `find`
};

}  // namespace tuft::atlas
