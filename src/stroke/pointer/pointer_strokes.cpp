#include "stroke/pointer/pointer_strokes.h"

#include "core/error.h"
#include "core/system/interrupt.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::stroke {

std::vector<Aim> aims_of(const StrokeSamples& trace, const Box& bounds, double pixel, bool pen) {
    const Placement& place = trace.placement;
    const Vec3 across = glm::cross(place.down, place.right);
    if (!(glm::length(across) > 0)) throw Error("the placement of a stroke has directions that are zero or parallel");
    const Vec3 outward = glm::normalize(across);
    const Axes axes = axes_across(outward, place.right, place.down);
    const double above = glm::dot(bounds.centre() - place.origin, outward) + bounds.diagonal();
    const Vec3 eye = place.origin + above * outward;
    std::vector<Aim> aims;
    aims.reserve(trace.samples.size());
    for (const StrokeSample& s : trace.samples) {
        Aim aim{.ray = {eye + s.position.x * axes.right - s.position.y * -axes.down, -outward},
                .view_right = axes.right,
                .view_up = -axes.down,
                .metres_per_pixel = pixel,
                .time = s.time};
        if (pen) {
            aim.pressure = s.pressure;
            aim.tilt = Vec2(s.tilt.x, -s.tilt.y);
            aim.turn = -s.roll;
        }
        aims.push_back(aim);
    }
    return aims;
}

std::vector<StrokeSamples> draw_with_pointer(PointerInput pointer, const std::vector<Aim>& aims) {
    std::vector<StrokeSamples> traces;
    const auto take = [&](const std::vector<StrokeStep>& steps) {
        for (const StrokeStep& step : steps) {
            if (step.kind == StrokeStep::Kind::begin) traces.push_back({.flat = false});
            for (const brush::Pose& pose : step.poses)
                traces.back().samples.push_back(
                    {.time = pose.time, .position = pose.position, .rotation = pose.rotation});
        }
    };
    for (const Aim& aim : aims) {
        check_interrupt();
        take(pointer.move(aim));
    }
    take(pointer.lift());
    return traces;
}

}  // namespace tuft::stroke
