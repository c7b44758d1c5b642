#pragma once

#include <optional>

#include "core/geometry/types.h"
#include "core/message.h"
#include "mesh/query/surface_query.h"

/// \file
/// Motion of a whole model between two revisions: another unit, upward axis or place. Called when a project is opened
/// on a revised model; document/fit.h compares the strokes.
namespace tuft::stroke {

/// Similarity p → to + scale · rotation (p − from), metres. `back` is the inverse.
struct ModelMotion {
    Vec3 from{0}, to{0};
    Quat rotation{1, 0, 0, 0};
    double scale = 1;

    Vec3 operator()(const Vec3& p) const { return to + scale * (rotation * (p - from)); }
    Vec3 back(const Vec3& p) const { return from + glm::inverse(rotation) * (p - to) / scale; }
};

/// Returns the motion that takes the former model to the revised one: a shift, one of the 24 rotations that map axes to
/// axes, a scale, or several of these. Empty where the revised model is in place, or has another shape.
///
/// The surfaces are compared at 600 points of each, distributed evenly over the area, by the mean distance d̄ to the
/// other surface; each distance counts at most 2 % of the box diagonal D. A motion is accepted if d̄ with it is less
/// than half of d̄ without it, less than half of d̄ with any smaller rotation, and less than 0.2 % of D, and if d̄ without
/// it is more than 0.01 % of D. A finer or coarser mesh, a hole or a new part is so no motion. A motion that maps the
/// shape to itself is not found. Cost: 1,200 closest points per rotation that the boxes allow.
std::optional<ModelMotion> find_motion(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised);

/// Returns the motion in words: "shifted by (20.0, 0.0, 0.0) mm", "1.200 times as large", "turned by 90 degrees".
Message describe(const ModelMotion& motion);

/// Returns the displacement of the former model's centre, metres.
Vec3 shift_of(const ModelMotion& motion);
/// Returns the angle of the rotation, radians.
double turn_of(const ModelMotion& motion);

}  // namespace tuft::stroke
