#include "render/gl/gl_camera.h"

#include <algorithm>
#include <cmath>

namespace tuft::render {
namespace {

double half_height(const GlCamera& c) {
    return c.parallel_height > 0 ? 0.5 * c.parallel_height : std::tan(0.5 * c.field_of_view);
}

}  // namespace

Ray ray_at(const GlCamera& c, double x, double y) {
    const double h = half_height(c);
    const double px = (2 * x / std::max(1, c.width) - 1) * h * c.width / std::max(1, c.height);
    const double py = (1 - 2 * y / std::max(1, c.height)) * h;
    if (c.parallel_height > 0) return {c.eye + px * c.right + py * c.up, c.forward};
    return {c.eye, glm::normalize(c.forward + px * c.right + py * c.up)};
}

Vec3 picture_point(const GlCamera& c, const Vec3& p) {
    const Vec3 d = p - c.eye;
    const double depth = glm::dot(d, c.forward);
    const double scale = (c.parallel_height > 0 ? 1.0 : 1.0 / depth) / half_height(c) * 0.5 * c.height;
    return {0.5 * c.width + scale * glm::dot(d, c.right), 0.5 * c.height - scale * glm::dot(d, c.up), depth};
}

double metres_per_pixel(const GlCamera& c, const Vec3& p) {
    const double depth = c.parallel_height > 0 ? 1.0 : std::max(1e-9, glm::dot(p - c.eye, c.forward));
    return 2 * half_height(c) * depth / std::max(1, c.height);
}

}  // namespace tuft::render
