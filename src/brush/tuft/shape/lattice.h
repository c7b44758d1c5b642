#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Free-form deformation of what a tuft carries, by a row of Bernstein lattices along its spines. `geometry_tuft.h`
/// places a geometry with it.
///
/// A cell lies between two neighbouring nodes of the spines and is tricubic,
///
///     X(s, t, u) = Σ_i Σ_j Σ_k B_i³(s) B_j³(t) B_k³(u) P_ijk,   s, t, u in [0, 1],
///
/// s over the broad side, t across it, u from root to tip. The layers k = 0 and 3 are those of the two nodes, the
/// layers between lie a third of the slope away: X and its slope are continuous from cell to cell, and X passes through
/// the nodes. Of a layer with K spines, F_k(x, y) = C_k + (x − x_k) X_k + y Y_k, and between two of them
///
///     F(x, y) = (1 − λ) F_k + λ F_{k+1},   λ = clamp((x − x_k) / (x_{k+1} − x_k), 0, 1),
///
/// taken at s = 0, 1/3, 2/3 and 1. Exact for affine motions of all layers: Bernstein polynomials reproduce linear
/// functions.
///
/// Source: [VanLaerhoven2007], 3.3 [Sederberg1986]. There one lattice spans the whole tuft; it
/// smooths a spine that bends near its tip, so here each segment has its own.
namespace tuft::brush {

/// Cross-section of a tuft at one node: the image of the point (x, y) of the resting section, metres.
struct LatticeFrame {
    Vec3 centre{0};   ///< of the spine's node
    Vec3 x{1, 0, 0};  ///< image of the ferrule's x; longer than 1 where the section is spread
    Vec3 y{0, 1, 0};
};

/// Frames of K spines at the same node numbers. [spines][nodes], root first
struct LatticeInput {
    std::vector<double> at;                         ///< [nodes] place along the hair, 0 root … 1 tip, increasing
    std::vector<double> spine_x;                    ///< [spines] metres over the broad side
    std::vector<std::vector<LatticeFrame>> frames;  ///< [spines][nodes]
    Vec2 lo{-1}, hi{1};                             ///< metres, box of the resting section
};

/// Coordinates of a point in a lattice.
struct LatticePlace {
    std::uint32_t cell = 0;
    Vec3 stu{0};
};

/// Lattice of a bent tuft: a tricubic Bernstein cell for each segment of the spine.
class SpineLattice {
  public:
    /// Control points of one cell, P[i][j][k].
    using Cell = std::array<std::array<std::array<Vec3, 4>, 4>, 4>;

    explicit SpineLattice(const LatticeInput& input);
    Vec3 at(const LatticePlace& place) const;
    std::span<const Cell> cells() const { return cells_; }

  private:
    std::vector<Cell> cells_;
};

/// Returns the place of a point of the resting tuft: (x, y) metres in the box of the section, `along` 0 root … 1 tip.
LatticePlace lattice_place(std::span<const double> at, const Vec2& lo, const Vec2& hi, const Vec2& point, double along);

}  // namespace tuft::brush
