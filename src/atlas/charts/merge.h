#pragma once

#include "atlas/charts/charts.h"

namespace tuft::atlas {

struct MergeOptions {
    double largest_chart = 0.15;   ///< part of the surface that a merged chart may have
    double largest_at_last = 0.3;  ///< the same once seams do not move any more
    double least_fill = 0.75;      ///< its area over that of its convex hull, or that of its parts
    double longest = 1.0;          ///< long side of its smallest rectangle, over the unit
    double largest_gap = 0.15;     ///< mean distance of the two sides of the chain, over its length
};

/// Merges neighbouring charts wherever the merged chart still lies flat within `options`,
/// tried by flattening it: small charts and long common seams first. Each round tries
/// disjoint pairs, in parallel; the result does not depend on the number of threads.
void merge_charts(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const MergeOptions& merge,
                  const ProgressFn& progress);

}  // namespace tuft::atlas
