#include "core/geometry/types.h"

#include <cmath>

namespace tuft {

Frame make_frame(const Vec3& origin, const Vec3& normal, const Vec3& hint) {
    Vec3 t = hint - glm::dot(hint, normal) * normal;
    if (glm::dot(t, t) < 1e-12) {
        // Any axis well away from the normal will do.
        const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        t = axis - glm::dot(axis, normal) * normal;
    }
    t = glm::normalize(t);
    return {.origin = origin, .t = t, .b = glm::cross(normal, t), .n = normal};
}

Vec3 parallel_transport(const Vec3& v, const Vec3& from, const Vec3& to) {
    const double c = glm::dot(from, to);
    if (c < -1.0 + 1e-12) {
        const Vec3 axis = make_frame(Vec3{0}, from).t;
        return 2.0 * glm::dot(v, axis) * axis - v;
    }
    const Vec3 w = glm::cross(from, to);
    return c * v + glm::cross(w, v) + (glm::dot(w, v) / (1.0 + c)) * w;
}

}  // namespace tuft
