#pragma once

#include <functional>
#include <span>

#include "footprint/stamp/stamp.h"
#include "footprint/stamp/walk.h"

/// \file
/// Clusters round several stamps, found by one search: stamps of a stroke lie a texel or two apart and reach nearly the
/// same clusters. `stroke` finds them for each batch; `plan_stamp` takes from them what each stamp reaches.
namespace tuft::footprint {

/// A footprint with its motion. The reference must outlive it.
struct MovedFootprint {
    std::reference_wrapper<const Footprint> footprint;
    Motion motion;
};

/// Finds the clusters that any of the stamps reaches, by a walk from the contact point of the stamp in the middle.
/// Where the surface is smooth there (see `walk_smooth`, with half of the discrepancy at which clusters get frames of
/// their own), one frame serves each of the stamps: the log map gives the positions, and the walk has shown that the
/// clusters are connected. Empty where the surface is not smooth, where one search costs more than one for each stamp,
/// or where normals of the stamps differ by more than 25°. `memory` is reused.
Neighbourhood find_neighbourhood(const Surface& surface, std::span<const MovedFootprint> stamps,
                                 const StampOptions& options, PlanScratch& scratch, Neighbourhood memory = {});

/// Stores the clusters whose discs intersect the picture in scratch.reached, ascending, and in scratch.discs the discs
/// that hold their texels in all poses, with the next cell. `stamp_frame` maps texels into the picture. Cost: 15 ns a
/// cluster of the neighbourhood.
void reach_clusters(const Neighbourhood& around, const Footprint& footprint, const Motion& motion, const Reach& reach,
                    const ClusterFrame& stamp_frame, PlanScratch& scratch);

}  // namespace tuft::footprint
