#include "app/viewport.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::app {
namespace {

Vec3 forward_of(const Orbit& o) {
    return {std::sin(-o.azimuth) * std::cos(o.elevation), std::cos(o.azimuth) * std::cos(o.elevation),
            -std::sin(o.elevation)};
}

}  // namespace

void Orbit::frame(const Box& box, double aspect) {
    target = box.centre();
    const double fit = std::min(1.0, aspect);
    distance = 0.55 * box.diagonal() / (std::tan(0.5 * field_of_view) * fit);
}

void Orbit::turn(double dx, double dy) {
    azimuth -= 0.007 * dx;
    elevation = std::clamp(elevation + 0.007 * dy, -1.55, 1.55);
}

void Orbit::pan(double dx, double dy, int height) {
    const double metres_per_pixel = 2 * distance * std::tan(0.5 * field_of_view) / std::max(1, height);
    const Vec3 forward = forward_of(*this);
    const Vec3 right = glm::normalize(glm::cross(forward, Vec3{0, 0, 1}));
    const Vec3 up = glm::cross(right, forward);
    target += metres_per_pixel * (-dx * right + dy * up);
}

void Orbit::zoom(double steps) { distance = std::clamp(distance * std::pow(0.88, steps), 1e-4, 1e3); }

render::GlCamera Orbit::camera(int width, int height, const Box& scene) const {
    render::GlCamera c;
    c.forward = forward_of(*this);
    c.right = glm::normalize(glm::cross(c.forward, Vec3{0, 0, 1}));
    c.up = glm::cross(c.right, c.forward);
    c.eye = target - distance * c.forward;
    c.field_of_view = field_of_view;
    const double reach = glm::distance(c.eye, scene.centre()) + scene.diagonal();
    c.near = std::max(1e-5, 0.02 * distance);
    c.far = std::max(reach, 2 * c.near);
    c.width = width;
    c.height = height;
    return c;
}

Vec3 ray_through(const render::GlCamera& c, double x, double y) {
    const double t = std::tan(0.5 * c.field_of_view);
    const double px = (2 * x / c.width - 1) * t * c.width / std::max(1, c.height);
    const double py = (1 - 2 * y / c.height) * t;
    return glm::normalize(c.forward + px * c.right + py * c.up);
}

}  // namespace tuft::app
