#include "atlas/texels/log_map.h"

#include <cmath>

namespace tuft::atlas {

Vec2 log_map(const Frame& frame, const Vec3& p, const Vec3& m) {
    const Vec3 d = p - frame.origin;
    const double c = glm::dot(m, frame.n);
    const double md = glm::dot(m, d), nd = glm::dot(frame.n, d);
    const double x = 1 - c;
    double series = kLogMapSeries.back();
    for (std::size_t i = kLogMapSeries.size() - 1; i-- > 0;) series = series * x + kLogMapSeries[i];
    const double h = 0.5 * (series * (md - nd) - (md + nd) / (1 + c));
    return {glm::dot(d, frame.t) + h * glm::dot(m, frame.t), glm::dot(d, frame.b) + h * glm::dot(m, frame.b)};
}

Vec2 transport_direction(const Frame& frame, const Vec3& t, const Vec3& from) {
    const Vec3 moved = parallel_transport(t, from, frame.n);
    const Vec2 direction{glm::dot(moved, frame.t), glm::dot(moved, frame.b)};
    const double length = glm::length(direction);
    return length > 0 ? direction / length : Vec2{1, 0};
}

}  // namespace tuft::atlas
