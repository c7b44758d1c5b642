#pragma once

#include <cstdint>
#include <vector>

#include "atlas/seams/half_edges.h"

namespace tuft::atlas {

/// Replaces each chain of seam edges between two corners by the shortest path between
/// them through the two charts it parts. Edges bent like creases are cheaper, so that
/// seams on them stay. Charts that were disks stay disks. `seam` [3n], borders included.
void straighten_seams(const Patch& patch, std::vector<std::uint8_t>& seam);

}  // namespace tuft::atlas
