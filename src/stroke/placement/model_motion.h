#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "core/message.h"
#include "mesh/query/surface_query.h"

/// \file
/// Motion of a model, and of its parts, between two revisions: another unit, upward axis, place or length. Called when
/// a project is opened on a revised model; drawing/follow_model.h moves the strokes, document/fit.h compares them.
namespace tuft::stroke {

/// What a motion may do.
enum class MotionFreedom {
    rigid,       ///< shift and turn
    similarity,  ///< and scale
    affine,      ///< and stretch
};

/// Affine map p → to + L (p − from) with L = scale · rotation · stretch, metres; `stretch` is symmetric, positive and
/// of determinant 1, the identity for a similarity.
struct ModelMotion {
    Vec3 from{0}, to{0};
    Quat rotation{1, 0, 0, 0};
    double scale = 1;
    Mat3 stretch{1};

    Vec3 operator()(const Vec3& p) const { return to + linear() * (p - from); }
    Vec3 back(const Vec3& p) const { return from + glm::inverse(linear()) * (p - to); }
    Mat3 linear() const { return scale * (glm::mat3_cast(rotation) * stretch); }
    /// Sets rotation, scale and stretch from L by its polar decomposition [Higham1986]. Precondition: the determinant
    /// is positive.
    void set_linear(const Mat3& linear);
};

/// Returns the motion that takes the former model to the revised one. Empty where the revised model is in place, or has
/// another shape.
///
/// Candidates are the 24 rotations that map axes to axes, with the boxes fitted to each other; the shift of the box's
/// centre alone; and the four rotations that map principal axes to principal axes, with a scale where the boxes differ
/// in size. `register_points` (registration.h) improves each.
///
/// The measure is d̄, the mean distance of the nearest 70 % of 600 points of each surface to the other one
/// (`mean_distance`). The points are distributed evenly over the area. Each distance counts at most 2 % of the box
/// diagonal D. A motion is accepted under four conditions: d̄ with it is less than half of d̄ without it, less than
/// half of d̄ with any simpler motion, and less than 0.2 % of D; d̄ without it is more than 0.01 % of D. Among motions
/// with equal d̄ the mean distance of all points decides. So a finer or coarser mesh, a hole or a new part is no
/// motion.
///
/// A motion that maps the shape to itself is not found. An affine motion, where it is allowed, is searched last. Cost:
/// about 0.2–1 s.
std::optional<ModelMotion> find_motion(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised,
                                       MotionFreedom freedom = MotionFreedom::similarity);

/// Motion of one part of a model.
struct PartMotion {
    std::string name;  ///< of the group
    ModelMotion motion;
};

/// How a model moved: as a whole, and the groups of its file that moved otherwise.
struct ModelChange {
    std::optional<ModelMotion> whole;
    std::vector<PartMotion> parts;  ///< in the order of the former model's groups

    bool none() const { return !whole && parts.empty(); }
    /// Returns the motion of a group: its own where it differs from the whole model's, else the model's.
    ModelMotion of(const std::string& group) const;
};

/// Returns `find_motion` and the rigid motions of groups. A group is compared with the group of the same name by the
/// same measure, with its own box and the whole model's motion for none. Groups without a name are no parts. Cost: the
/// closest points of 1,200 points for each common group, and a registration for each that moved.
ModelChange find_change(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised,
                        MotionFreedom freedom = MotionFreedom::similarity);

/// Returns the motion in words: "shifted by (20.0, 0.0, 0.0) mm", "1.200 times as large", "turned by 90 degrees".
Message describe(const ModelMotion& motion);

/// Returns the displacement of the former model's centre, metres.
Vec3 shift_of(const ModelMotion& motion);
/// Returns the angle of the rotation, radians.
double turn_of(const ModelMotion& motion);

}  // namespace tuft::stroke
