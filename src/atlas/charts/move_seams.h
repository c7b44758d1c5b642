#pragma once

#include "atlas/charts/charts.h"

namespace tuft::atlas {

/// Shortens the seams between finished charts, each as far as the two charts it parts lie flat
/// within `options` afterwards, tried by flattening them: seams that gain most first. Each
/// round moves seams of disjoint pairs, in parallel; the result does not depend on the number
/// of threads. True when a seam was moved.
bool move_seams(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
