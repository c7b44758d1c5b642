#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "atlas/seams/chart_mesh.h"

/// \file
/// Flattening of a disk with little stretch: LSCM, ARAP and untangling. Called by atlas/charts.
namespace tuft::atlas {

/// Options of `arap` and `flatten`. Energies are per area of the chart: the mean of (σ₁ − 1)² + (σ₂ − 1)², with σ the
/// singular values of the map of a triangle.
struct ArapOptions {
    int iterations = 40;                         ///< most steps, ≥ 1
    double tolerance = 1e-3;                     ///< stop when the energy falls by less than this fraction per step
    double converged_energy = 1e-12;             ///< stop below this energy
    double abandon_energy = 1e300;               ///< stop when the predicted energy stays above this
    std::function<void()> on_step;               ///< called before each iteration; may throw to stop
    std::function<bool(int steps)> should_stop;  ///< called after each iteration with the current `uv`; true stops
};

/// Returns the least squares conformal map [Levy2002] of a disk by CGAL, scaled to the chart's area. Empty
/// when CGAL fails or the result is not finite.
std::optional<std::vector<Vec2>> lscm(const ChartMesh& chart);

/// Minimises Σ_t Σ_k cot α_k |(u_i − u_j) − R_t (x_i − x_j)|² over UVs u and one rotation R_t per triangle,
/// alternating local and global steps [Liu2008]. `uv` is the start and the result. Returns its energy
/// before the last step. With `faces`, only those move; the corners that they share with others are fixed.
///
/// The matrix is factorised once (flatten/ldlt.h), in an order found from the start. Slivers get a minimum height so
/// that their weights are finite.
double arap(const ChartMesh& chart, std::vector<Vec2>& uv, const ArapOptions& options = {},
            std::span<const std::uint32_t> faces = {});
/// Returns the energy of `arap` for given UVs.
double arap_energy(const ChartMesh& chart, const std::vector<Vec2>& uv);

/// Moves the UVs of triangles without positive area, and of their neighbours, until every triangle round them has
/// positive area. Returns true when none is left.
bool untangle(const ChartMesh& chart, std::vector<Vec2>& uv);

/// Returns UVs of a disk. Plane charts are projected. Others start from their projection, or from LSCM where the
/// projection is bad or gives flipped triangles, followed by ARAP and untangling. Scaled to the chart's area. Empty
/// when the chart is no disk or the result is not finite.
std::vector<Vec2> flatten(const ChartMesh& chart, const ArapOptions& options = {});

/// Scales the UVs so that their area is the chart's.
void scale_to_area(const ChartMesh& chart, std::vector<Vec2>& uv);

}  // namespace tuft::atlas
