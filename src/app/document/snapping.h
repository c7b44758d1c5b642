#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stroke/gesture/symmetry.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/snap.h"

/// \file
/// Where a drawing snaps to while it is placed: the planes of symmetry, and level with drawings that are placed
/// already. Called by tools/writing_tool.h. Window thread.
namespace tuft::app {

/// What a drawing can snap to.
struct SnapTargets {
    std::vector<stroke::SnapPlane> planes;      ///< of symmetry
    std::vector<stroke::Placement> placements;  ///< of other drawings
};

/// Returns the planes that the symmetry mirrors in; without one the upright planes across x and y through the middle of
/// the model. Placements: each once.
SnapTargets snap_targets(const stroke::Symmetry& symmetry, const Box& model,
                         std::span<const stroke::Placement> placements);

/// A place and why it is there.
struct SnappedPlace {
    mesh::SurfacePoint at;
    std::vector<std::vector<Vec3>> guides;  ///< lines along the surface, metres, to be shown
};

/// Returns the place near `p` in the nearest plane within `reach` metres, and in a second one where that is within
/// reach, too; nothing where none is. Besides the planes of the targets those are, for each other drawing, the plane
/// through its middle across its right (`p` then lies above or below it) and across its down (beside it).
std::optional<SnappedPlace> snap(const mesh::SurfaceQuery& surface, const Vec3& p, const SnapTargets& targets,
                                 double reach);

}  // namespace tuft::app
