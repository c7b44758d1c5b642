#pragma once

#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// \file
/// `SurfaceMapping::project`: rays through flat samples onto the model, and where a stroke on it ends. Called by
/// `map_to_surface`, `hand_path` and fit.h.
namespace tuft::stroke {

/// `SurfaceMapping::project` of `map_to_surface`.
SurfaceTrace map_projected(const mesh::SurfaceQuery& query, const StrokeSamples& trace);

/// Takes a projected stroke off all but one sheet of the model: a stripe over a wheel arch ends at the arch's lip, goes
/// on behind it, and leaves the wheel.
///
/// Two points lie on one sheet when the surface that the rays see leads from one to the other without an edge. An edge
/// is a change of depth by more than s = `drape_radius` / 2 and by more than twice the distance, or the border of the
/// model. A gap of at most s across, whose sides differ in depth by at most s, is no edge. The stroke stays on the
/// sheet under both of its ends; where these lie on two, on the one under the longest pressed part of its path. Other
/// samples of `mapped` are no longer on the surface; height and frame become those of the nearest sample of the sheet,
/// raised over all that the rays hit until the stroke comes back.
///
/// `mapped`: of `trace`. Returns one flag per sample, true where the stroke has left its sheet. Does nothing for other
/// mappings, and returns nothing. Cost: eight rays per s of path, 1 µs each; where a path crosses an edge also up to
/// 300,000 rays.
std::vector<bool> leave_other_sheets(const mesh::SurfaceQuery& query, const StrokeSamples& trace, SurfaceTrace& mapped);

}  // namespace tuft::stroke
