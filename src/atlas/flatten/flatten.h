#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "atlas/seams/chart_mesh.h"

/// SurfaceMapping a disk flat with as little stretch as possible.
namespace tuft::atlas {

/// Energies below are per area of the chart: the mean of (σ₁ − 1)² + (σ₂ − 1)².
struct ArapOptions {
    int iterations = 40;
    double tolerance = 1e-3;                 ///< stop when the energy falls by less than this part per step
    double enough = 1e-12;                   ///< stop below this energy
    double hopeless = 1e300;                 ///< stop when the energy will stay above this, as far as can be told
    std::function<void()> on_step;           ///< called before each iteration; may throw to stop
    std::function<bool(int steps)> in_vain;  ///< asked after each of them, `uv` being as it is
                                             ///< then: true stops
};

/// Least squares conformal map (Lévy et al. 2002) of a disk by CGAL, scaled to the
/// chart's area; nothing when CGAL fails or the numbers are not finite.
std::optional<std::vector<Vec2>> lscm(const ChartMesh& chart);

/// Minimises Σ_t Σ_k cot α_k |(u_i − u_j) − R_t (x_i − x_j)|² over UVs u and one rotation
/// R_t per triangle, by turns (Liu et al. 2008: local/global). The matrix is factorised
/// once, by Eigen's simplicial L D Lᵀ with an approximate minimum degree ordering: against CHOLMOD with AMD,
/// with METIS and supernodal, unwrapping a car of 0.12, 0.48 and 1.1 million triangles takes 0.90, 0.52 and 0.71 of the
/// time, and no BLAS makes bits depend on the CPU. Slivers are laid out a little fatter so that their weights stay
/// finite. `uv` is the start and the result; returns its energy before the last step. With `faces`, only those are laid
/// anew, and the corners that they share with others stay where they are.
double arap(const ChartMesh& chart, std::vector<Vec2>& uv, const ArapOptions& options = {},
            std::span<const std::uint32_t> faces = {});
/// That energy of UVs as they are.
double arap_energy(const ChartMesh& chart, const std::vector<Vec2>& uv);

/// Moves vertices of triangles without positive area, and their neighbours, until
/// every triangle around them has some; true when none is left.
bool untangle(const ChartMesh& chart, std::vector<Vec2>& uv);

/// Flat by the shortest way that works: plane charts are projected; others start from
/// their projection, or from LSCM where that is bad or leads to flipped triangles, and go
/// through ARAP and untangling. The result is scaled to the chart's area; empty when the chart is
/// no disk or nothing finite came out.
std::vector<Vec2> flatten(const ChartMesh& chart, const ArapOptions& options = {});

/// Scales the UVs so that their area is the chart's.
void scale_to_area(const ChartMesh& chart, std::vector<Vec2>& uv);

}  // namespace tuft::atlas
