#pragma once

#include <vector>

#include "atlas/charts/charts.h"

namespace tuft::atlas {

/// Where a chart lies to begin with that took some triangles over from its neighbours: the
/// triangles that it shares with `old` stay, the others are unfolded from those one by one.
/// There must be a shared one.
std::vector<Vec2> carry_uvs(const FlatChart& old, const ChartMesh& chart);

}  // namespace tuft::atlas
