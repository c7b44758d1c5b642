#pragma once

#include "atlas/charts/charts.h"
#include "atlas/pack/pack.h"

/// \file
/// Halves charts that waste space on the page. Called by `unwrap` before the final packing.
namespace tuft::atlas {

/// Result of `cut_to_pack`.
struct CutToPack {
    int cuts = 0;     ///< number of halved charts
    Packing packing;  ///< best packing of the resulting charts
};

/// Halves large charts across their length where this covers the page better: rings, long bows, a few large
/// squares. Of more than 48 charts, those whose boxes are emptiest are cut where the fullest boxes remain. Continues
/// only while less than `goal` of the page is covered. Cuts are retained if each gains the factor `kCutGain` (1.004 of
/// many charts) or they reach the goal; of those that do, the shortest are made. The halves retain the UVs of the
/// whole. `gap` as in `ChartOptions`.
CutToPack cut_to_pack(const mesh::TriangleMesh& mesh, CutMesh& cut, double gap, PackOptions options, double goal);

inline constexpr double kGoodUse = 0.65;   ///< sufficient covered fraction of a page
inline constexpr double kTightUse = 0.85;  ///< goal of `Cutting::tight`
inline constexpr double kCutGain = 1.015;  ///< smallest ratio of coverage after a cut to that before

/// Returns the borders of the charts in the plane, for `pack`.
std::vector<std::vector<Vec2>> chart_borders(const CutMesh& cut);

}  // namespace tuft::atlas
