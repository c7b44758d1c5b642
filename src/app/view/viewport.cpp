#include "app/view/viewport.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::app {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kNearest = 1e-3, kFurthest = 1e3;  // metres to the target

struct Axes {
    Vec3 right, up, forward;
};

Axes axes_of(const Orbit& o) {
    const Vec3 forward{-std::sin(o.azimuth) * std::cos(o.elevation), std::cos(o.azimuth) * std::cos(o.elevation),
                       -std::sin(o.elevation)};
    const Vec3 right{std::cos(o.azimuth), std::sin(o.azimuth), 0};
    const Vec3 up = glm::cross(right, forward);
    const double c = std::cos(o.roll), s = std::sin(o.roll);
    return {c * right - s * up, s * right + c * up, forward};
}

}  // namespace

void Orbit::frame(const Box& box) {
    target = box.centre();
    distance = 0.56 * box.diagonal() / std::tan(0.5 * field_of_view);
}

void Orbit::follow(const std::optional<stroke::ModelMotion>& motion, const Box& box) {
    if (motion) {
        target = (*motion)(target);
        distance *= motion->scale;
    }
    if (glm::any(glm::lessThan(target, box.lo)) || glm::any(glm::greaterThan(target, box.hi))) frame(box);
}

void Orbit::look_from(StandardView view) {
    roll = 0;
    parallel_until_turned = parallel_until_turned || !parallel;
    parallel = true;
    elevation = view == StandardView::top ? kQuarter : view == StandardView::bottom ? -kQuarter : 0;
    azimuth = view == StandardView::back    ? 2 * kQuarter
              : view == StandardView::right ? kQuarter
              : view == StandardView::left  ? -kQuarter
                                            : 0;
}

void Orbit::set_parallel(bool on) {
    parallel = on;
    parallel_until_turned = false;
}

void Orbit::turn(double dx, double dy) {
    if (parallel_until_turned && (dx != 0 || dy != 0)) set_parallel(false);
    const double c = std::cos(roll), s = std::sin(roll);
    azimuth -= 0.007 * (c * dx + s * dy);
    elevation = std::clamp(elevation + 0.007 * (c * dy - s * dx), -kQuarter, kQuarter);
}

void Orbit::pan(double dx, double dy, int side) {
    const double metres_per_pixel = 2 * distance * std::tan(0.5 * field_of_view) / std::max(1, side);
    const Axes a = axes_of(*this);
    target += metres_per_pixel * (-dx * a.right + dy * a.up);
}

void Orbit::fly(const Vec3& push, const Vec3& twist, bool level) {
    constexpr double kTurn = 2, kNearer = 1.5;  // radians, and powers of e in distance, per second at full deflection
    if (parallel_until_turned && (twist.x != 0 || twist.y != 0)) set_parallel(false);
    const Axes a = axes_of(*this);
    target -= 2 * distance * std::tan(0.5 * field_of_view) * (push.x * a.right + push.y * a.up);
    distance = std::clamp(distance * std::exp(-kNearer * push.z), kNearest, kFurthest);
    const double c = std::cos(roll), s = std::sin(roll);
    azimuth -= kTurn * (c * twist.y + s * twist.x);
    elevation = std::clamp(elevation + kTurn * (c * twist.x - s * twist.y), -kQuarter, kQuarter);
    if (!level) roll += kTurn * twist.z;
}

void Orbit::zoom(double steps, const Vec3& towards) {
    const double before = distance;
    distance = std::clamp(distance * std::pow(0.88, steps), kNearest, kFurthest);
    // Only sideways: the target keeps its depth.
    const Axes a = axes_of(*this);
    const Vec3 d = towards - target;
    target += (1 - distance / before) * (glm::dot(d, a.right) * a.right + glm::dot(d, a.up) * a.up);
}

render::GlCamera Orbit::camera(int width, int height, const Box& scene) const {
    render::GlCamera c;
    const Axes a = axes_of(*this);
    c.right = a.right;
    c.up = a.up;
    c.forward = a.forward;
    // The angle spans the picture's shorter side.
    const double tall = static_cast<double>(height) / std::max(1, std::min(width, height));
    c.field_of_view = 2 * std::atan(tall * std::tan(0.5 * field_of_view));
    c.width = width;
    c.height = height;
    if (parallel) {
        const double reach = scene.diagonal() + glm::distance(target, scene.centre());
        c.parallel_height = 2 * tall * distance * std::tan(0.5 * field_of_view);
        c.eye = target - reach * c.forward;
        c.near = 0;
        c.far = 2 * reach;
        return c;
    }
    c.eye = target - distance * c.forward;
    const double reach = glm::distance(c.eye, scene.centre()) + scene.diagonal();
    c.near = std::max(1e-5, 0.02 * distance);
    c.far = std::max(reach, 2 * c.near);
    return c;
}

}  // namespace tuft::app
