#include "brush/state/tuft_state.h"

#include "brush/rod/wedge.h"

namespace tuft::brush {

Pose interpolate(const Pose& a, const Pose& b, double t) {
    return {glm::mix(a.position, b.position, t), glm::slerp(a.rotation, b.rotation, t), a.time + t * (b.time - a.time)};
}

double height_over(const ContactPlane& plane, const Vec3& p) {
    if (plane.beyond_normal == Vec3{0}) return glm::dot(p - plane.origin, plane.normal);
    const Wedge wedge{{plane.origin, plane.beyond_origin}, {plane.normal, plane.beyond_normal}};
    return edge_distance(wedge, kEdgeRounding, p).z;
}

}  // namespace tuft::brush
