#pragma once

#include "footprint/stamp/walk.h"

/// Where the surface folds within a stamp, its clusters by exact shortest ways over the triangles.
namespace tuft::footprint {

/// Between the spokes of a wheel ways bend round corners narrower than a cluster, and lead round an
/// opening on either side: the walk over the clusters finds places there that are nearer than the
/// straight line in space. With more than a hundredth of such clusters (`occluded` of them), all are
/// placed anew: (u, v) is the exact way's length in the direction in which it leaves `from`, a
/// frame whose origin lies in `triangle` and in the cluster that `start` names; each cluster lies
/// turned as the way arrives. Behind a corner, where all ways leave in one direction, lengths hold
/// and pictures are drawn out. Cost: nothing where nothing folds, else 1.5 µs a triangle within
/// reach; where that would be more than 20 ms, the places of the walk stay.
void resolve_occluded(const Surface& surface, std::uint32_t triangle, const Frame& from, const Reach& reach,
                      const Start& start, std::size_t occluded, PlanScratch& scratch);

}  // namespace tuft::footprint
