#pragma once

#include <cstdint>
#include <vector>

#include "atlas/seams/half_edges.h"

/// \file
/// Straightening of all seams of a patch. Called by atlas/charts.
namespace tuft::atlas {

/// Replaces each chain of seam edges between two corners by the shortest path between them through its two charts.
/// Edges bent like creases cost less, so seams on them do not move. Charts that were disks remain disks. `seam`
/// [3n], borders included.
void straighten_seams(const Patch& patch, std::vector<std::uint8_t>& seam);

}  // namespace tuft::atlas
