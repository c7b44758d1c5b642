#pragma once

#include "atlas/charts.h"
#include "atlas/pack.h"

namespace tuft::atlas {

/// Halves large charts across their length where the page is then covered better: rings, long
/// bows, a few large squares. Only while less than `kGoodUse` of the page is covered, and only
/// if each cut gains `kCutGain`. The halves lie flat as the whole did. `gap` as in
/// `ChartOptions`. Returns the number of cuts.
int cut_to_pack(const mesh::TriangleMesh& mesh, CutMesh& cut, double gap, PackOptions options);

inline constexpr double kGoodUse = 0.66;   ///< covered part of the page
inline constexpr double kCutGain = 1.035;  ///< over before

/// Borders of the charts in the plane, as `pack` wants them.
std::vector<std::vector<Vec2>> chart_borders(const CutMesh& cut);

}  // namespace tuft::atlas
