#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/flatten/flatten.h"
#include "atlas/seams/chart_mesh.h"
#include "atlas/seams/half_edges.h"
#include "atlas/seams/rejected_changes.h"
#include "core/system/progress.h"

/// \file
/// Cuts a mesh into charts that can be flattened with little stretch. Called by `unwrap`.
namespace tuft::atlas {

/// Limits of charts.
struct ChartOptions {
    double l2 = 1.0045;      ///< largest mean stretch of a chart
    double largest = 1.35;   ///< largest stretch at 99.9 % of a chart's area
    double l2_all = 1.0028;  ///< largest mean stretch of all charts together, after merging
    double worst = 3;        ///< largest stretch of a triangle, where possible
    /// Long side of a chart's smallest rectangle, over the unit: the width of a page that is half covered.
    double longest = 1.35;
    double grown = 0.3;                ///< largest fraction of the surface of a chart while seams move
    std::uint32_t triangles = 200000;  ///< most triangles of a chart: the cost of flattening grows faster than linearly
    RequestedSeams seams;              ///< no chart crosses these
    double gap = 0;                    ///< smallest distance between parts of a chart's border, over the unit
};

/// Returns the options of trial flattenings: these stop early when the result is clear.
ArapOptions trial_arap(const ChartOptions& options);

/// Number of triangles from which a mesh is glued in blocks and its seams are moved in one round, only where the
/// gain is large.
inline constexpr std::size_t kBlockwiseThreshold = 500000;

/// A chart and its UVs, in the same unit. Every triangle has positive area, and the border does not cross itself.
struct FlatChart {
    ChartMesh mesh;             ///< of the chart
    std::vector<Vec2> uv;       ///< [n_vertices of `mesh`]
    double l2 = 1;              ///< stretch
    double worst = 1;           ///< largest stretch of a triangle
    std::uint32_t copies = 1;   ///< charts of the atlas that this one stands for
    std::uint32_t version = 0;  ///< unique for every chart and change; 0: not assigned
};

/// A mesh cut into charts.
struct CutMesh {
    double unit = 1;                   ///< metres: square root of the surface's area
    std::vector<std::uint32_t> twin;   ///< [3n] opposite half-edges, kNone at requested seams
    std::vector<std::uint32_t> glued;  ///< the same, kNone at seams
    std::vector<FlatChart> charts;
    std::vector<std::uint32_t> copies;  ///< [n_triangles] triangles that each stands for; empty: one
    std::uint32_t versions = 0;         ///< last assigned version
    RejectedChanges rejected;           ///< changes that need no second trial
    std::vector<std::uint32_t> place;   ///< [n_triangles] scratch buffer of `make_chart`
};

/// Cuts and flattens the whole mesh. Every triangle lies in one chart. Of `uncut`, `unit`, `twin` and `copies` are
/// given. The first overload makes it.
CutMesh cut_into_charts(const mesh::TriangleMesh& mesh, const ChartOptions& options, const ProgressFn& progress);
CutMesh cut_into_charts(const mesh::TriangleMesh& mesh, CutMesh uncut, const ChartOptions& options,
                        const ProgressFn& progress);

/// Returns the unit of a mesh: the square root of its surface's area, metres.
double chart_unit(const mesh::TriangleMesh& mesh);

/// Budget of the stretch of all charts together: Σ L2² · area · copies, updated as charts change.
class StretchBudget {
  public:
    StretchBudget(const CutMesh& cut, double l2);
    /// Returns true when `now` may replace `before`: it stretches less, or stays within the budget.
    bool allows(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now) const;
    void spend(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now);
    /// Remaining fraction of the budget.
    double left() const { return all_ > area_ ? (all_ - used_) / (all_ - area_) : 0; }

  private:
    double used_ = 0, all_ = 0, area_ = 0;
};

/// Assigns a version to charts without one.
void number_charts(CutMesh& cut);

/// `whole_patch` returns all triangles as one patch. `seam_flags` returns a flag for each of its half-edges: it is
/// a seam.
Patch whole_patch(const mesh::TriangleMesh& mesh, const CutMesh& cut);
std::vector<std::uint8_t> seam_flags(const CutMesh& cut);

/// Returns the convex hull of a chart's border in the plane.
std::vector<Vec2> chart_hull(const FlatChart& chart);

/// `cut_again` cuts each of `charts` (ascending indices) into two or more and flattens those. `cut_out` cuts along
/// every edge of the given triangles of the mesh.
void cut_again(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> charts,
               const ChartOptions& options, const ProgressFn& progress);
void cut_out(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> triangles,
             const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
