#pragma once

#include <optional>

#include "core/geometry/types.h"
#include "core/message.h"
#include "mesh/query/surface_query.h"

/// Whether a revised model is the former one, moved as a whole.
namespace tuft::stroke {

/// p → to + scale · rotation (p − from), metres.
struct ModelMotion {
    Vec3 from{0}, to{0};
    Quat rotation{1, 0, 0, 0};
    double scale = 1;

    Vec3 operator()(const Vec3& p) const { return to + scale * (rotation * (p - from)); }
    Vec3 back(const Vec3& p) const { return from + glm::inverse(rotation) * (p - to) / scale; }
};

/// The motion that takes the former model to the revised one: a shift, a turn that takes axes to
/// axes, another size, or several of these, as another export, unit or upward axis makes them.
/// Nothing where the revised model lies where the former one lay, or is another shape. Both are
/// compared at 600 points of each, even over the area, by the mean distance d̄ to the other surface
/// (each at most 2 % of the box diagonal D): a motion counts where it leaves less than half of the
/// d̄ without it and of any smaller turn, and less than 0.2 % of D, and only where that without it
/// is more than 0.01 % of D. So a finer or coarser mesh, a hole or a new part is no motion; a
/// motion that takes the shape to itself is not seen. Cost: 1,200 closest points for each of at
/// most 24 turns that the boxes allow.
std::optional<ModelMotion> find_motion(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised);

/// In words: "shifted by (20.0, 0.0, 0.0) mm", "1.200 times as large", "turned by 90 degrees".
Message describe(const ModelMotion& motion);

/// How far the middle of the former model went, metres.
Vec3 shift_of(const ModelMotion& motion);
double turn_of(const ModelMotion& motion);  ///< radians

}  // namespace tuft::stroke
