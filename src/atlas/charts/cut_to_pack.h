#pragma once

#include "atlas/charts/charts.h"
#include "atlas/pack/pack.h"

namespace tuft::atlas {

struct CutToPack {
    int cuts = 0;
    Packing packing;  ///< of the charts as they are, the best that was found
};

/// Halves large charts across their length where the page is then covered better: rings, long
/// bows, a few large squares. Only while less than `goal` of the page is covered, and only if
/// the cuts gain a part of `kCutGain` each, or reach the goal. The halves lie flat as the whole
/// did. `gap` as in `ChartOptions`.
CutToPack cut_to_pack(const mesh::TriangleMesh& mesh, CutMesh& cut, double gap, PackOptions options, double goal);

inline constexpr double kGoodUse = 0.65;   ///< covered part of a page that is good enough
inline constexpr double kTightUse = 0.85;  ///< where it shall be as large as it can
inline constexpr double kCutGain = 1.015;  ///< over before

/// Borders of the charts in the plane, as `pack` wants them.
std::vector<std::vector<Vec2>> chart_borders(const CutMesh& cut);

}  // namespace tuft::atlas
