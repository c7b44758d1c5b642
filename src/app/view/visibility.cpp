#include "app/view/visibility.h"

#include "app/input/pointer.h"

namespace tuft::app {

bool is_seen(const mesh::SurfaceQuery& query, const render::GlCamera& camera, const Vec4f& section, const Vec3& place,
             double tolerance) {
    const Vec3 at = render::picture_point(camera, place);
    const Aim aim{.ray = render::ray_at(camera, at.x, at.y), .section = section};
    const double depth = glm::dot(place - aim.ray.origin, aim.ray.direction);
    if (depth <= 0) return false;
    if (section != Vec4f(0) && glm::dot(Vec4f(Vec4(place, 1)), section) > 0) return false;
    const auto hit = aim_at(query, aim);
    return !hit || hit->distance >= depth - tolerance;
}

}  // namespace tuft::app
