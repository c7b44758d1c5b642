#pragma once

#include <span>
#include <vector>

/// \file
/// Quadratic programme over nonnegative unknowns: the dual of the programmes of chain_solver.h.
namespace tuft::brush {

/// Returns the minimum of ½ xᵀ Q x + bᵀ x over x >= 0. `q`: [n n], row after row. `start`: its positive elements are
/// the first guess of the free ones. Precondition: Q is symmetric and positive definite. Method: active sets
/// ([Lawson1974], chapter 23, in normal equations); finite, and stopped after 4 n + 10 changes of the set. Cost:
/// O(n³) per change.
std::vector<double> minimise_nonnegative(std::span<const double> q, std::span<const double> b,
                                         std::span<const double> start);

}  // namespace tuft::brush
