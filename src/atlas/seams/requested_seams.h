#pragma once

#include <cstdint>
#include <span>

#include "atlas/atlas.h"

/// \file
/// Seams that the user requests: along face groups or sharp edges. Called by charts.h.
namespace tuft::atlas {

/// Removes the edges of requested seams from `twin` [3n], so that they are borders for all chart operations. Throws
/// `Error` when only face groups are requested and the mesh has none.
void cut_requested_seams(const mesh::TriangleMesh& mesh, const RequestedSeams& seams, std::span<std::uint32_t> twin);

}  // namespace tuft::atlas
