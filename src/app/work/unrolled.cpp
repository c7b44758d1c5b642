#include "app/work/unrolled.h"

#include <glm/gtx/quaternion.hpp>

namespace tuft::app {
namespace {

/// Unit axes of a placement; `down` is perpendicular to `right`.
struct Axes {
    Vec3 right, down, normal;
};

Axes axes_of(const stroke::Placement& p) {
    const Vec3 right = glm::normalize(p.right), normal = glm::normalize(glm::cross(p.down, p.right));
    return {right, glm::cross(right, normal), normal};
}

Vec2 seen_in(const Axes& plane, const Vec3& v) {
    return {glm::dot(v, plane.right), glm::dot(v, plane.down)};
}

/// The frame of `to` in the frame of `from`.
PlaneFrame step(const stroke::Placement& from, const stroke::Placement& to) {
    const Axes a = axes_of(from), b = axes_of(to);
    const Quat back = glm::rotation(b.normal, a.normal);
    const Vec3 apart = to.origin - from.origin;
    const Vec2 direction = seen_in(a, apart) + seen_in(a, back * apart);
    const double length = glm::length(direction);
    return {.origin = length > 0 ? glm::length(apart) / length * direction : Vec2(0),
            .right = seen_in(a, back * b.right),
            .down = seen_in(a, back * b.down)};
}

}  // namespace

std::vector<PlaneFrame> unrolled(std::span<const stroke::Placement> placements) {
    std::vector<PlaneFrame> frames(placements.size());
    for (std::size_t i = 1; i < placements.size(); ++i) {
        const PlaneFrame& before = frames[i - 1];
        frames[i] = before;
        if (placements[i] == placements[i - 1]) continue;
        const PlaneFrame on = step(placements[i - 1], placements[i]);
        const auto turned = [&](const Vec2& v) { return v.x * before.right + v.y * before.down; };
        frames[i] = {.origin = before.at(on.origin), .right = turned(on.right), .down = turned(on.down)};
    }
    return frames;
}

}  // namespace tuft::app
