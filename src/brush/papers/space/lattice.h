#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Free-form deformation lattice between two spines. The model `chain` (chain.h) carries a tuft of two spines with it.
///
///     X(s, t, u) = Σ_i Σ_j Σ_k B_i¹(s) B_j¹(t) B_k^K(u) P_ijk,   s, t, u in [0, 1],
///
/// with B the Bernstein polynomials. s goes from spine 0 to spine 1, t across both, u from root to tip. Exact for
/// affine motions of its control points, since Bernstein polynomials reproduce linear functions. Inside, X is not on
/// the spines: a lattice of degree K smooths.
///
/// Source: [VanLaerhoven2007], 3.3 [Sederberg1986].
namespace tuft::brush {

/// Control points that two spines drive.
struct Lattice {
    int degree = 0;                                           ///< K
    std::vector<std::array<std::array<Vec3, 2>, 2>> control;  ///< [K+1][i][j], metres, root first
};

/// Returns X at (s, t, u).
Vec3 lattice_point(const Lattice& lattice, double s, double t, double u);

/// Two spines of a lattice, root first, the same arc lengths.
struct LatticeSpines {
    std::span<const double> at;                    ///< arc length over the whole length, 0 … 1
    std::array<std::span<const Vec3>, 2> node;     ///< metres
    std::array<std::span<const Vec3>, 2> outward;  ///< metres, from the spine to its side of the lattice
    std::array<std::span<const Vec3>, 2> across;   ///< metres, from the spine to the side t = 1
};

/// Returns the lattice whose side i moves with spine i: P_ijk = node + outward ± across at u = k/K, interpolated
/// linearly along the spine.
Lattice span_lattice(const LatticeSpines& spines, int degree);

}  // namespace tuft::brush
