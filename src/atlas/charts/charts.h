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

/// The mesh cut into charts that lie flat.
namespace tuft::atlas {

struct ChartOptions {
    double l2 = 1.0045;                ///< stretch that a chart may have on average
    double largest = 1.35;             ///< and at 99.9 % of its area
    double l2_all = 1.0028;            ///< and that all may have together, once they are merged
    double worst = 3;                  ///< and anywhere, where that can be helped
    double longest = 1.35;             ///< long side of a chart's smallest rectangle, over the unit: no longer
                                       ///< than a page that charts cover to a half is wide
    double grown = 0.3;                ///< part of the surface that a chart may grow to as seams move
    std::uint32_t triangles = 200000;  ///< of a chart, at most: what laying it flat costs grows
                                       ///< faster than they do
    RequestedSeams seams;              ///< no chart crosses these
    double gap = 0;                    ///< that parts of a chart's border keep from each other, over the unit
};

/// How well charts are laid out to see whether they can be: stops early where that is clear.
ArapOptions trial_arap(const ChartOptions& options);

/// Triangles of a mesh that is glued in blocks and whose seams are moved in one round, where it gains much.
inline constexpr std::size_t kBlockwiseThreshold = 500000;

/// A chart and its UVs, over the same unit; every triangle has positive area and the
/// border does not cross itself.
struct FlatChart {
    ChartMesh mesh;
    std::vector<Vec2> uv;
    double l2 = 1;              ///< stretch
    double worst = 1;           ///< largest stretch of a triangle
    std::uint32_t version = 0;  ///< another one for every chart and change; 0: none yet
};

struct CutMesh {
    double unit = 1;                   ///< metres: square root of the surface's area
    std::vector<std::uint32_t> twin;   ///< [3n] opposite half-edges, kNone where a seam was asked for
    std::vector<std::uint32_t> glued;  ///< the same, kNone at seams
    std::vector<FlatChart> charts;
    std::uint32_t versions = 0;  ///< that charts had so far
    RejectedChanges rejected;
    std::vector<std::uint32_t> place;  ///< [n_triangles] room for `make_chart`
};

/// Cuts and flattens the whole mesh. Every triangle lies in one chart.
CutMesh cut_into_charts(const mesh::TriangleMesh& mesh, const ChartOptions& options, const ProgressFn& progress);

/// The stretch of all charts together, L2² times area, as charts change.
class StretchBudget {
  public:
    StretchBudget(const CutMesh& cut, double l2);
    /// Whether `now` may take the place of `before`: stretches less or within the budget.
    bool allows(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now) const;
    void spend(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now);
    /// Part that is left of what charts may stretch.
    double left() const { return all_ > area_ ? (all_ - used_) / (all_ - area_) : 0; }

  private:
    double used_ = 0, all_ = 0, area_ = 0;
};

/// Gives charts that have none their version.
void number_charts(CutMesh& cut);

/// All triangles as one patch, and a flag at each of its half-edges that is a seam now.
Patch whole_patch(const mesh::TriangleMesh& mesh, const CutMesh& cut);
std::vector<std::uint8_t> seam_flags(const CutMesh& cut);

/// Hull of a chart's border in the plane.
std::vector<Vec2> chart_hull(const FlatChart& chart);

/// Cuts each of `charts` (ascending indices) into two or more and flattens those. `singles`
/// cuts along every edge of the named triangles of the mesh instead.
void cut_again(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> charts,
               const ChartOptions& options, const ProgressFn& progress);
void cut_out(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> triangles,
             const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
