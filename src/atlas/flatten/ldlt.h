#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Factors of sparse symmetric matrices whose rows are vertices in the plane. Called by flatten/arap.cpp.
namespace tuft::atlas {

/// A sparse symmetric matrix.
struct SymmetricMatrix {
    struct Entry {
        std::uint32_t row = 0, column = 0;  ///< two different ones, in either order
        double value = 0;
    };
    std::vector<double> diagonal;  ///< [n]
    std::vector<Entry> entries;    ///< off the diagonal, each stored once; those at one place add up
};

/// A = Pᵀ L D Lᵀ P with unit lower L and diagonal D, in the order of `dissect`. Multifrontal [Duff1983]: what the
/// vertices of one part of the dissection and their later neighbours have in common is one dense matrix. No pivoting.
/// The order of all sums is fixed, so that the bits depend neither on the CPU nor on the number of threads, which
/// factor subtrees. Ordered and factored by turns on one thread, a grid of 96,000 vertices takes CHOLMOD 5.12
/// (supernodal, with OpenBLAS) 2.9 times as long in the order of AMD and 6 times in that of METIS, and Eigen's
/// simplicial LDLᵀ 3.3 times.
class LdltFactor {
  public:
    /// Factors a matrix. `at` [n] is where its rows lie: any numbers will do, the nearer those that share entries the
    /// better. Returns false where a pivot is 0 or no number. Cost: for a chart of 96,000 vertices 0.16 s, 35 MB.
    bool compute(SymmetricMatrix matrix, std::span<const Vec2> at);
    /// Replaces right hand sides, two numbers a row, by the solution. Precondition: `compute` returned true.
    void solve(std::span<Vec2> x);

  private:
    /// Columns of L with the same rows. They are stored with `stride` rows: those of the pivots, those beyond, zeros.
    struct Front {
        std::uint32_t first = 0, n_pivots = 0;  ///< rows of L
        std::uint32_t n_beyond = 0;             ///< rows that its columns reach beyond its pivots
        std::uint32_t n_children = 0, stride = 0;
        std::uint32_t subtree = 0;           ///< first of the fronts that end in this one
        std::size_t beyond = 0, values = 0;  ///< where these begin in `beyond_` and `values_`
    };
    struct Rows;
    struct Stack;
    /// What a row gets from an earlier one of a subtree.
    struct RowUpdate {
        double x = 0, y = 0;
        std::uint32_t row = 0;
    };

    void find_fronts(const Rows& rows);
    void assemble(const Rows& rows, const Front& front, Stack& stack);
    std::size_t n_values(std::uint32_t first, std::uint32_t last) const;
    void find_subtrees();
    bool factor_in_turn(const Rows& rows, std::uint32_t first, std::uint32_t last, Stack& stack);
    bool factor(const Rows& rows, std::uint32_t first, std::uint32_t last, Stack& stack);
    void solve_down(std::uint32_t first, std::uint32_t last, std::uint32_t end_row, std::vector<RowUpdate>& passed);
    void solve_up(std::uint32_t first, std::uint32_t last);

    std::vector<std::uint32_t> place_;   ///< row of L of each row of the matrix
    std::vector<Front> fronts_;          ///< children before parents
    std::vector<std::uint32_t> beyond_;  ///< rows of L, ascending for each front
    std::unique_ptr<double[]> values_;   ///< of L, column by column
    std::size_t n_values_ = 0;           ///< that there is room for
    std::size_t n_values_used_ = 0;
    std::vector<double> inverse_;          ///< 1 / D
    std::vector<std::uint32_t> subtrees_;  ///< last fronts of those that threads share, ascending
    std::uint32_t largest_stride_ = 0;
    std::vector<double> x_, y_;
    std::vector<std::vector<RowUpdate>> passed_;
};

}  // namespace tuft::atlas
