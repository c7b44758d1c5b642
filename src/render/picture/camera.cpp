#include "render/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"

namespace tuft::render {
namespace {

void check(const View& view, int width, int height) {
    constexpr int kMaxSide = 16384;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        throw Error(Message("picture size {}x{} is not within 1x1 to 16384x16384", width, height));
    if (!(view.field_of_view > 0.001 && view.field_of_view < 3))
        throw Error("the field of view must be between 0.06 and 171 degrees");
    if (!std::isfinite(view.azimuth) || !(std::abs(view.elevation) <= std::numbers::pi / 2 + 1e-9))
        throw Error("the view's elevation must be within -90 to 90 degrees");
    if (!(view.margin >= 0 && view.margin < 0.49)) throw Error("the view's margin must be within 0 to 0.49");
}

}  // namespace

Camera make_camera(const View& view, int width, int height, std::span<const Vec3f> points) {
    check(view, width, height);
    Camera c;
    c.width = width;
    c.height = height;
    c.tan_half_height = std::tan(0.5 * view.field_of_view);
    const double ca = std::cos(view.azimuth), sa = std::sin(view.azimuth);
    const double ce = std::cos(view.elevation), se = std::sin(view.elevation);
    c.right = {ca, sa, 0};
    c.forward = {-sa * ce, ca * ce, -se};
    c.up = {-sa * se, ca * se, ce};
    const double aspect = static_cast<double>(width) / height;

    if (view.target) {
        double distance = view.distance;
        if (!(distance > 0)) distance = 0.5 * view.width_at_target / (c.tan_half_height * aspect);
        if (!(distance > 0) || !std::isfinite(distance))
            throw Error("the camera's distance to its target must be positive");
        c.eye = *view.target - distance * c.forward;
        return c;
    }
    if (points.empty()) {
        c.eye = -c.forward;
        return c;
    }
    // With camera coordinates (x, y, z) of the points, |x - cx| <= T (z + d) for all of them is
    // cx >= A - T d and cx <= T d - B for A = max(x - T z), B = max(-x - T z); likewise for y.
    const double ty = c.tan_half_height * (1 - 2 * view.margin), tx = ty * aspect;
    constexpr double kLow = -std::numeric_limits<double>::infinity();
    double ax = kLow, bx = kLow, ay = kLow, by = kLow;
    for (const Vec3f& point : points) {
        const Vec3 p(point);
        const double x = glm::dot(p, c.right), y = glm::dot(p, c.up), z = glm::dot(p, c.forward);
        ax = std::max(ax, x - tx * z);
        bx = std::max(bx, -x - tx * z);
        ay = std::max(ay, y - ty * z);
        by = std::max(by, -y - ty * z);
    }
    const double distance = std::max((ax + bx) / (2 * tx), (ay + by) / (2 * ty));
    c.eye = 0.5 * (ax - bx) * c.right + 0.5 * (ay - by) * c.up - distance * c.forward;
    return c;
}

Vec3 ray_direction(const Camera& c, double x, double y) {
    const double s = 2 * c.tan_half_height / c.height;
    return glm::normalize(c.forward + s * (x - 0.5 * c.width) * c.right - s * (y - 0.5 * c.height) * c.up);
}

std::optional<Vec3> project(const Camera& c, const Vec3& p) {
    const Vec3 d = p - c.eye;
    const double z = glm::dot(d, c.forward);
    if (!(z > 0)) return std::nullopt;
    const double s = c.height / (2 * c.tan_half_height * z);
    return Vec3{0.5 * c.width + s * glm::dot(d, c.right), 0.5 * c.height - s * glm::dot(d, c.up), z};
}

}  // namespace tuft::render
