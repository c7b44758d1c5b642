#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/half_edges.h"

namespace tuft::atlas {

/// How far a seam may leave its chain, over the chain's length, by default.
inline constexpr float kSeamReach = 0.25f;

/// Replaces each chain of seam edges between two corners by the shortest path between
/// them through the two charts it parts. Edges bent like creases are cheaper, so that
/// seams on them stay. Charts that were disks stay disks. `seam` [3n], borders included.
/// `reach` [n] limits how far seams along a triangle may move; empty: `kSeamReach`.
void straighten_seams(const Patch& patch, std::vector<std::uint8_t>& seam,
                      std::span<const float> reach = {});

}  // namespace tuft::atlas
