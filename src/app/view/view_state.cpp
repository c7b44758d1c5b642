#include "app/view/view_state.h"

#include <algorithm>

namespace tuft::app {

Vec4f section_plane(const ViewState& view, const Box& b) {
    if (!view.section.on) return Vec4f(0);
    const int k = view.section.axis;
    Vec3 normal(0);
    normal[k] = k == 1 ? -1 : 1;
    const double margin = 1e-3 * b.diagonal(), kept = view.section.position * (b.size()[k] + 2 * margin);
    const double at = normal[k] > 0 ? b.lo[k] - margin + kept : b.hi[k] + margin - kept;
    return Vec4f(Vec4(normal, -normal[k] * at));
}

double pixels_per_side(const AtlasView& a) {
    return a.zoom * std::min(a.area.width, a.area.height);
}

Vec2 on_atlas(const AtlasView& a, const Vec2& uv) {
    const Vec2 d = (uv - a.centre) * pixels_per_side(a);
    return {a.area.x + 0.5 * a.area.width + d.x, a.area.y + 0.5 * a.area.height - d.y};
}

Vec2 uv_at(const AtlasView& a, double x, double y) {
    const Vec2 d(x - a.area.x - 0.5 * a.area.width, a.area.y + 0.5 * a.area.height - y);
    return a.centre + d / pixels_per_side(a);
}

}  // namespace tuft::app
