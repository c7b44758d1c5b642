#include "app/tools/aim.h"

namespace tuft::app {

render::GlCamera camera_of(const Session& s) {
    return s.view.orbit.camera(s.view.area.width, s.view.area.height,
                               s.paint_thread ? s.paint_thread->model().mesh->bounds : Box{{-1, -1, -1}, {1, 1, 1}});
}

Aim aim_of(const Session& s, const Event& e) {
    const render::GlCamera c = camera_of(s);
    Aim aim{.ray = render::ray_at(c, e.x - s.view.area.x, e.y - s.view.area.y),
            .view_right = c.right,
            .view_up = c.up,
            .metres_per_pixel = render::metres_per_pixel(c, s.view.orbit.target),
            .time = e.time,
            .pressure = e.pressure,
            .section = section_plane(s.view, s.paint_thread->model().mesh->bounds)};
    if (e.pressure >= 0) {
        aim.tilt = Vec2(e.tilt.x, -e.tilt.y);
        aim.turn = e.turn;
    }
    return aim;
}

}  // namespace tuft::app
