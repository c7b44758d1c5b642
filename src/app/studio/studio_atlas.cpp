#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/studio/studio.h"

/// The atlas beside the model; moving strokes over the model.
namespace tuft::app {
bool Studio::in_atlas(const Event& e) const {
    const Area& a = session_.view.atlas.area;
    return session_.view.atlas.shown && e.x >= a.x && e.x < a.x + a.width && e.y >= a.y && e.y < a.y + a.height;
}

void Studio::draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height) {
    const Session& s = session_;
    if (!s.view.atlas.shown) return;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const bool dark = s.ui.settings().theme == Theme::dark;
    scene_->draw_atlas({.part = {s.view.atlas.area.x, height - s.view.atlas.area.y - s.view.atlas.area.height,
                                 s.view.atlas.area.width, s.view.atlas.area.height},
                        .centre = s.view.atlas.centre,
                        .pixels_per_side = pixels_per_side(s.view.atlas),
                        .backdrop = dark ? Vec3f(0.19f) : Vec3f(0.55f)},
                       options);
}

// Where the cursor over the model lies in the atlas.
std::optional<Vec2> Studio::atlas_cursor() const {
    const Session& s = session_;
    if (!s.view.atlas.shown || !cursor_inside_ || in_atlas(cursor_)) return std::nullopt;
    const stroke::Model& m = s.paint_thread->model();
    const auto hit = aim_at(*m.query, aim_of(cursor_));
    if (!hit) return std::nullopt;
    const auto uv = [&](std::size_t k) { return Vec2(m.atlas.corner_uvs[3 * hit->triangle + k]); };
    return uv(0) + hit->b1 * (uv(1) - uv(0)) + hit->b2 * (uv(2) - uv(0));
}

void Studio::atlas_press(const Event& e) {
    if (e.button == 0)
        look_at_uv(uv_at(session_.view.atlas, e.x, e.y));
    else
        drag_ = Drag::atlas;
}

void Studio::atlas_wheel(const Event& e) {
    AtlasView& v = session_.view.atlas;
    const Vec2 under = uv_at(session_.view.atlas, e.x, e.y);
    v.zoom = std::clamp(v.zoom * std::pow(1.15, e.steps), 0.5, 200.0);
    v.centre += under - uv_at(session_.view.atlas, e.x, e.y);
    v.centre = glm::clamp(v.centre, Vec2(-0.5), Vec2(1.5));
}

// Turns the model so that a place of the atlas is seen from straight above it.
void Studio::look_at_uv(const Vec2& uv) {
    Session& s = session_;
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

bool Studio::shift_press(const Event& e) {
    Session& s = session_;
    if (!s.journal.moves) return false;
    s.journal.from = s.journal.to = aim_at(*s.paint_thread->model().query, aim_of(e));
    return true;
}

void Studio::shift_release(const Event& e) {
    Session& s = session_;
    JournalState& j = s.journal;
    if (const auto to = aim_at(*s.paint_thread->model().query, aim_of(e))) j.to = to;
    if (glm::distance(j.from->position, j.to->position) > 1e-5)
        s.paint_thread->post(
            EditStrokes{.ids = {j.selected.begin(), j.selected.end()}, .move = shift_between(*j.from, *j.to)});
    j.from.reset();
    j.to.reset();
    j.moves = false;
}

}  // namespace tuft::app
