#pragma once

#include "footprint/stamp/walk.h"

/// \file
/// Exact positions of texel clusters where the surface folds within a stamp. Called by `plan_stamp`.
namespace tuft::footprint {

/// Replaces the positions of the clusters by exact geodesics when more than a hundredth of them are occluded
/// (`occluded` is their number). The cluster search is inexact there: geodesics bend round corners narrower than a
/// cluster or pass an opening on either side, as between the spokes of a wheel, and positions come out closer than
/// the straight line in space.
///
/// (u, v) is the geodesic's length in the direction in which it leaves `start.frame`. Each cluster is rotated by the
/// direction in which the geodesic arrives. Behind a corner, where all geodesics leave in one direction, lengths are
/// correct and pictures are stretched. Cost: none without folds; else 0.5 µs per triangle within reach. Where that
/// exceeds 10 ms, the positions of the search are retained.
void resolve_occluded(const Surface& surface, const Reach& reach, const Start& start, std::size_t occluded,
                      PlanScratch& scratch);

}  // namespace tuft::footprint
