#pragma once

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Factors of sparse symmetric matrices, to the bit those of Eigen. Called by flatten/arap.cpp.
namespace tuft::atlas {

/// A = Pᵀ L D Lᵀ P with unit lower L and diagonal D, in the order that AMD gives. No pivoting, one thread; every sum is
/// in the order of `Eigen::SimplicialLDLT`, so that the bits are those on every CPU. Where columns of L have the same
/// rows (supernodes; Ng and Peyton 1993) they are applied together.
class LdltFactor : private Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> {
  public:
    using Matrix = Eigen::SparseMatrix<double>;

    /// Factors a matrix, of which the lower half is stored. Returns false where a pivot is 0 or no number. Cost: half
    /// that of Eigen's for a chart of 360,000 vertices, 2 s.
    bool compute(const Matrix& lower);
    /// Replaces right hand sides, two numbers a row, by the solution. Precondition: `compute` returned true. Cost: half
    /// that of Eigen's, which reads L once for each.
    void solve(std::span<Vec2> x);

  private:
    using Base = SimplicialLDLT;

    bool factorise(const Matrix& upper);
    int find_pattern(const Matrix& upper, int k);
    int chain_length(int top) const;
    double apply_chain(int k, int top, int length, double d);

    std::vector<double> row_;         ///< of L D, being solved
    std::vector<int> pattern_, met_;  ///< columns of the row in topological order; the row that met a column last
    std::vector<Vec2> permuted_;
};

}  // namespace tuft::atlas
