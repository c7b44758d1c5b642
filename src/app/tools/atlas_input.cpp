#include "app/tools/atlas_input.h"

#include <algorithm>
#include <cmath>

#include "app/tools/aim.h"

namespace tuft::app {

bool in_atlas(const AtlasView& atlas, const Event& e) {
    const Area& a = atlas.area;
    return atlas.shown && e.x >= a.x && e.x < a.x + a.width && e.y >= a.y && e.y < a.y + a.height;
}

std::optional<Vec2> atlas_cursor(const Session& s, const Event* cursor) {
    if (!s.view.atlas.shown || !cursor || in_atlas(s.view.atlas, *cursor)) return std::nullopt;
    const stroke::Model& m = s.paint_thread->model();
    const auto hit = aim_at(*m.query, aim_of(s, *cursor));
    if (!hit) return std::nullopt;
    const auto uv = [&](std::size_t k) { return Vec2(m.atlas.corner_uvs[3 * hit->triangle + k]); };
    return uv(0) + hit->b1 * (uv(1) - uv(0)) + hit->b2 * (uv(2) - uv(0));
}

void zoom_atlas(AtlasView& v, const Event& e) {
    const Vec2 under = uv_at(v, e.x, e.y);
    v.zoom = std::clamp(v.zoom * std::pow(1.15, e.steps), 0.5, 200.0);
    v.centre += under - uv_at(v, e.x, e.y);
    v.centre = glm::clamp(v.centre, Vec2(-0.5), Vec2(1.5));
}

void look_at_uv(Session& s, const Vec2& uv) {
    const stroke::Model& m = s.paint_thread->model();
    const auto size = static_cast<double>(m.atlas.size);
    if (!(uv.x >= 0 && uv.x < 1 && uv.y >= 0 && uv.y < 1)) return;
    const auto x = static_cast<std::uint32_t>(uv.x * size), y = static_cast<std::uint32_t>(uv.y * size);
    const std::uint32_t slot = m.texels.slot_of_tile[y / atlas::kTile * m.texels.tiles_per_side + x / atlas::kTile];
    if (slot == kNone) return;
    const auto t = static_cast<int>(y % atlas::kTile * atlas::kTile + x % atlas::kTile);
    if (m.texels.tiles[slot].cluster[static_cast<std::size_t>(t)] == atlas::kNoCluster) return;
    const auto on = m.query->closest_point(Vec3(m.texels.position(slot, t)));
    if (!on) return;
    s.view.orbit.target = on->position;
    s.view.orbit.roll = 0;
    if (s.view.orbit.parallel_until_turned) s.view.orbit.set_parallel(false);
    s.view.orbit.elevation = std::asin(std::clamp(on->normal.z, -1.0, 1.0));
    if (std::hypot(on->normal.x, on->normal.y) > 1e-3) s.view.orbit.azimuth = std::atan2(on->normal.x, -on->normal.y);
}

}  // namespace tuft::app
