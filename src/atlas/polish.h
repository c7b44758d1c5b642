#pragma once

#include "atlas/charts.h"

namespace tuft::atlas {

/// Straightens the seams between finished charts and lays every chart flat anew from
/// where it was. Seams of charts that would no longer lie flat within `options` stay.
void polish_charts(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options,
                   const ProgressFn& progress);

}  // namespace tuft::atlas
