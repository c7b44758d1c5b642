#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "brush/papers/space/frames.h"
#include "brush/state/tuft_state.h"

/// \file
/// Half spaces that the nodes of a model must not leave. The macro and the truss model project onto them.
namespace tuft::brush {

/// Points p with dot(p − origin, normal) ≥ 0 are outside the object.
struct HalfSpace {
    Vec3 origin{0};        ///< metres, world
    Vec3 normal{0, 0, 1};  ///< unit

    /// Height of p, metres.
    double height(const Vec3& p) const { return glm::dot(p - origin, normal); }
    /// p, or the nearest point of the half space.
    Vec3 projected(const Vec3& p) const { return p - std::min(0.0, height(p)) * normal; }
};

/// Returns the half space of a plane for a point near p. Beside a convex edge it is the face that p is further above:
/// outside of one face is outside of the object.
inline HalfSpace half_space_of(const ContactPlane& plane, const Vec3& p) {
    const HalfSpace face{plane.origin, plane.normal}, beyond{plane.beyond_origin, plane.beyond_normal};
    return beyond.normal != Vec3{0} && beyond.height(p) > face.height(p) ? beyond : face;
}

/// Returns one half space per node; none without planes.
inline std::vector<HalfSpace> half_spaces(std::span<const ContactPlane> planes, std::span<const Vec3> nodes) {
    std::vector<HalfSpace> out;
    out.reserve(nodes.size());
    for (std::size_t i = 0; i < nodes.size() && !planes.empty(); ++i)
        out.push_back(half_space_of(plane_of(planes, i), nodes[i]));
    return out;
}

}  // namespace tuft::brush
