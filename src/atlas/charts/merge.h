#pragma once

#include "atlas/charts/charts.h"

/// \file
/// Merging of adjacent charts. Called by `unwrap`.
namespace tuft::atlas {

/// Limits of the shape of a merged chart.
struct MergeOptions {
    double largest_chart = 0.15;   ///< largest fraction of the surface of a merged chart
    double largest_at_last = 0.3;  ///< the same after the last seam move
    double least_fill = 0.75;      ///< its area over that of its convex hull, unless its parts have less
    double longest = 1.0;          ///< long side of its smallest rectangle, over the unit
    double largest_gap = 0.15;     ///< mean distance of the two sides of the chain, over its length
};

/// Merges adjacent charts where the merged chart can be flattened within `options`, by trial: small charts and long
/// common seams first. Each round tries disjoint pairs in parallel. The result does not depend on the number of
/// threads.
void merge_charts(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const MergeOptions& merge,
                  const ProgressFn& progress);

}  // namespace tuft::atlas
