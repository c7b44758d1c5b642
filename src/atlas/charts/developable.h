#pragma once

#include "atlas/seams/seam_graph.h"

/// Seams between developable charts.
namespace tuft::atlas {

/// Seams [3n] of a patch between charts as large as the limits allow; `seam` [3n] marks those to
/// begin with, empty: every edge is one. The graph that finds them takes three times the patch's
/// memory, and goes.
std::vector<std::uint8_t> developable_seams(const Patch& patch, std::span<const std::uint8_t> seam,
                                            const GluingLimits& limits, const ProgressFn& progress);

/// Seams [3 n_triangles] between charts of a few dozen triangles, to begin with: a large mesh is
/// split into blocks of compact shape, glued each by itself on all threads, because the order in
/// which far charts are glued does not matter while they are small. Empty below `kBlockwiseThreshold`
/// triangles. `twin` as in `make_patch`. The same for any number of threads.
std::vector<std::uint8_t> small_chart_seams(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin,
                                            double unit, GluingLimits limits, const ProgressFn& progress);

}  // namespace tuft::atlas
