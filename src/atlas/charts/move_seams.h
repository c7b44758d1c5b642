#pragma once

#include "atlas/charts/charts.h"

/// \file
/// Shortening of seams between charts. Called by `unwrap`.
namespace tuft::atlas {

/// Shortens the seams between finished charts while both charts can be flattened within `options`, by trial: the
/// largest gain first. Each round moves seams of disjoint pairs in parallel. The result does not depend on the
/// number of threads. Returns true when a seam moved.
bool move_seams(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
