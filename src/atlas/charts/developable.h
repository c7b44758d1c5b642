#pragma once

#include "atlas/seams/seam_graph.h"

/// \file
/// Initial seams between nearly developable charts. Called by charts.h.
namespace tuft::atlas {

/// Returns seams [3n] of a patch between charts as large as the limits allow. `seam` [3n] marks the initial seams;
/// empty: every edge. Memory of the graph: three times the patch's, freed on return.
std::vector<std::uint8_t> developable_seams(const Patch& patch, std::span<const std::uint8_t> seam,
                                            const GluingLimits& limits, const ProgressFn& progress);

/// Returns initial seams [3 n_triangles] between charts of a few dozen triangles. The mesh is split into compact
/// blocks, and each is glued on its own thread: the order of gluing distant charts does not matter while they are
/// small. Empty below `kBlockwiseThreshold` triangles. `twin` as in `make_patch`. The same for any number of
/// threads.
std::vector<std::uint8_t> small_chart_seams(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin,
                                            double unit, GluingLimits limits, const ProgressFn& progress);

}  // namespace tuft::atlas
