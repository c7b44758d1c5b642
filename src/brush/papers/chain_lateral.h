#pragma once

#include <vector>

/// \file
/// Lateral nodes of the model `chain` (chain.h): how far the hair reaches to one side of the spine. Arrays go from
/// root to tip.
///
/// The distances d of the lateral nodes minimise, for each side separately [X: Chu and Tai solve them together with
/// the spine],
///
///     E = Σ w_i C_s |d_i − rest_i|^m + Σ C_b |β_i|^m + Σ T_i h(d_i − stuck_i),
///
/// β_i the angle between the lines from lateral node i to its neighbours, less that of the resting tuft, by its small
/// angle Δslope; rest_i = r − r_l + s(θ). Chu and Tai print r + s(θ) with a major radius d + r_l, which makes no
/// circle at rest [R]. h as in chain_solver.h.
///
/// Source: [Chu2002], 4.1.1, 4.1.2, 4.2.2.
namespace tuft::brush {

/// Side nodes along one flank of the tuft, and what pulls on them.
struct LateralChain {
    std::vector<double> at;     ///< m, arc length, strictly rising; the first node is held at its rest
    std::vector<double> rest;   ///< m
    std::vector<double> outer;  ///< m, d of the resting tuft: its slope is that of β = 0
    std::vector<double> drag;   ///< T, N, or 0
    std::vector<double> stuck;  ///< m, d of a node that stayed where it lay
    double stretch = 300;       ///< N/m²: force per length over d − rest where that is `reference`
    double bend_length = 2e-3;  ///< m, over which a push spreads along the tuft
    double reference = 3e-3;    ///< m
    double smoothing = 1e-5;    ///< ε, m
    double exponent = 3;        ///< m
};

/// Returns d, metres. Method: Newton on a convex function. Cost: 20 µs for 9 nodes.
std::vector<double> solve_lateral_chain(const LateralChain& side);

/// E and its gradient, for tests; the gradient at the root is 0.
struct LateralChainEnergy {
    double value = 0;
    std::vector<double> gradient;
};
LateralChainEnergy lateral_chain_energy(const LateralChain& side, const std::vector<double>& d);

}  // namespace tuft::brush
