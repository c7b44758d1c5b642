#include "stroke/placement/snap.h"

#include <cmath>

namespace tuft::stroke {

std::optional<mesh::SurfacePoint> surface_point_in_plane(const mesh::SurfaceQuery& surface, const Vec3& p,
                                                         const SnapPlane& plane, double reach) {
    constexpr int kSteps = 60;
    constexpr double kExact = 1e-6;  // metres
    Vec3 at = p;
    for (int step = 0; step < kSteps; ++step) {
        at -= plane.distance(at) * plane.normal;
        const auto on = surface.closest_point(at, 2 * reach);
        if (!on || glm::distance(on->position, p) > reach) return std::nullopt;
        at = on->position;
        if (std::abs(plane.distance(at)) <= kExact) return on;
    }
    return std::nullopt;
}

}  // namespace tuft::stroke
