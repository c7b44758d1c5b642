#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/flatten/dissection.h"
#include "core/types.h"

namespace tuft::atlas {

/// The lower half of a symmetric matrix by columns; entries that come twice are added.
struct LowerMatrix {
    struct Entry {
        std::uint32_t row, column;
        double value;
    };
    LowerMatrix(std::size_t size, std::span<const Entry> entries);

    std::vector<std::uint32_t> start, row;
    std::vector<double> value;
};

/// L D Lᵀ of a symmetric matrix on the edges of a flat mesh, without pivoting: the multifrontal
/// method (Duff and Reid 1983) over the nodes of a dissection, so that all of the work is on small
/// dense blocks. One thread.
class PlanarFactor {
  public:
    /// Rows and columns in the dissection's order. False where
    /// a pivot is zero or not finite.
    bool compute(const LowerMatrix& lower, const Dissection& dissection);

    /// Replaces two right hand sides, the coordinates of `x`, by their solutions.
    void solve(std::span<Vec2> x) const;

  private:
    /// Columns [begin, end) of L: the rows of the block are these, then those in `rows`.
    struct Block {
        std::uint32_t begin, end;
        std::size_t first_row, n_rows;  // below the block's own, in `rows_`
        std::size_t values;             // in `values_`, by columns
    };
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> rows_;
    std::vector<double> values_, diagonal_;
    std::size_t tallest_ = 0;  // block
};

}  // namespace tuft::atlas
