#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/quaternion.hpp>

#include "app/panels/panels.h"
#include "app/studio/studio.h"

/// The atlas beside the model; moving strokes over the model.
namespace tuft::app {
namespace {

double pixels_per_side(const Session& s) {
    return s.view.atlas_zoom * std::min(s.atlas_area.width, s.atlas_area.height);
}

Vec2 on_atlas(const Session& s, const Vec2& uv) {
    const Vec2 d = (uv - s.view.atlas_centre) * pixels_per_side(s);
    return {s.atlas_area.x + 0.5 * s.atlas_area.width + d.x, s.atlas_area.y + 0.5 * s.atlas_area.height - d.y};
}

Vec2 uv_at(const Session& s, double x, double y) {
    const Vec2 d(x - s.atlas_area.x - 0.5 * s.atlas_area.width, s.atlas_area.y + 0.5 * s.atlas_area.height - y);
    return s.view.atlas_centre + d / pixels_per_side(s);
}

}  // namespace

bool Studio::in_atlas(const Event& e) const {
    const Area& a = session_.atlas_area;
    return session_.view.atlas && e.x >= a.x && e.x < a.x + a.width && e.y >= a.y && e.y < a.y + a.height;
}

void Studio::draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height) {
    const Session& s = session_;
    if (!s.view.atlas) return;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const bool dark = s.ui.settings().theme == Theme::dark;
    scene_->draw_atlas({.part = {s.atlas_area.x, height - s.atlas_area.y - s.atlas_area.height, s.atlas_area.width,
                                 s.atlas_area.height},
                        .centre = s.view.atlas_centre,
                        .pixels_per_side = pixels_per_side(s),
                        .backdrop = dark ? Vec3f(0.19f) : Vec3f(0.55f)},
                       options);
}

// Where the cursor over the model lies in the atlas.
std::optional<Vec2> Studio::atlas_cursor() const {
    const Session& s = session_;
    if (!s.view.atlas || !cursor_inside_ || in_atlas(cursor_)) return std::nullopt;
    const stroke::Model& m = s.painter->model();
    const auto hit = aim_at(*m.query, aim_of(cursor_));
    if (!hit) return std::nullopt;
    const auto uv = [&](std::size_t k) { return Vec2(m.atlas.corner_uvs[3 * hit->triangle + k]); };
    return uv(0) + hit->b1 * (uv(1) - uv(0)) + hit->b2 * (uv(2) - uv(0));
}

void Studio::atlas_press(const Event& e) {
    if (e.button == 0)
        look_at_uv(uv_at(session_, e.x, e.y));
    else
        drag_ = Drag::atlas;
}

void Studio::atlas_wheel(const Event& e) {
    ViewState& v = session_.view;
    const Vec2 under = uv_at(session_, e.x, e.y);
    v.atlas_zoom = std::clamp(v.atlas_zoom * std::pow(1.15, e.steps), 0.5, 200.0);
    v.atlas_centre += under - uv_at(session_, e.x, e.y);
    v.atlas_centre = glm::clamp(v.atlas_centre, Vec2(-0.5), Vec2(1.5));
}

// Turns the model so that a place of the atlas is seen from straight above it.
void Studio::look_at_uv(const Vec2& uv) {
    Session& s = session_;
    const stroke::Model& m = s.painter->model();
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

void atlas_marks(const Session& s, const std::optional<Vec2>& cursor) {
    if (!s.view.atlas || !s.painter) return;
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const auto at = [&](const Vec2& uv) {
        return ImVec2(static_cast<float>(on_atlas(s, uv).x), static_cast<float>(on_atlas(s, uv).y));
    };
    const ImVec2 a(static_cast<float>(s.atlas_area.x), static_cast<float>(s.atlas_area.y));
    const ImVec2 b(a.x + static_cast<float>(s.atlas_area.width), a.y + static_cast<float>(s.atlas_area.height));
    draw->PushClipRect(a, b, true);
    draw->AddRect(at({0, 1}), at({1, 0}), IM_COL32(150, 150, 155, 160));
    if (cursor) {
        draw->AddCircle(at(*cursor), s.ui.px(7), IM_COL32(20, 20, 24, 255), 24, s.ui.px(3.5f));
        draw->AddCircle(at(*cursor), s.ui.px(7), IM_COL32(255, 196, 64, 255), 24, s.ui.px(1.8f));
    }
    const stroke::Model& m = s.painter->model();
    const auto print = [&](const char* between) {
        char text[160];
        const int n = std::snprintf(text, sizeof text, s.ui.tr(m.atlas.n_charts == 1 ? "%u chart" : "%u charts"),
                                    m.atlas.n_charts);
        if (const atlas::AtlasReport* report = s.painter->atlas_report())
            std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "%s%s %.3f%s%s %.0f %%", between,
                          s.ui.tr("stretch"), report->l2_stretch, between, s.ui.tr("used"), 100 * report->utilisation);
        return std::string(text);
    };
    std::string text = print("    ");
    if (ImGui::CalcTextSize(text.c_str()).x + s.ui.px(32) > b.x - a.x) text = print("\n");
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw->AddRectFilled(ImVec2(a.x + s.ui.px(8), a.y + s.ui.px(8)),
                        ImVec2(a.x + s.ui.px(24) + size.x, a.y + s.ui.px(16) + size.y), IM_COL32(24, 24, 26, 190),
                        s.ui.px(5));
    draw->AddText(ImVec2(a.x + s.ui.px(16), a.y + s.ui.px(12)), IM_COL32(240, 240, 240, 255), text.c_str());
    draw->PopClipRect();
    draw->AddLine(ImVec2(a.x - 1, a.y), ImVec2(a.x - 1, b.y), ImGui::GetColorU32(ImGuiCol_Border));
}

RigidMove shift_between(const mesh::SurfacePoint& from, const mesh::SurfacePoint& to) {
    return {.from = from.position, .to = to.position, .rotation = glm::rotation(from.normal, to.normal)};
}

bool Studio::shift_press(const Event& e) {
    Session& s = session_;
    if (!s.journal.moves) return false;
    s.journal.from = s.journal.to = aim_at(*s.painter->model().query, aim_of(e));
    return true;
}

void Studio::shift_release(const Event& e) {
    Session& s = session_;
    JournalState& j = s.journal;
    if (const auto to = aim_at(*s.painter->model().query, aim_of(e))) j.to = to;
    if (glm::distance(j.from->position, j.to->position) > 1e-5)
        s.painter->post(
            EditStrokes{.ids = {j.selected.begin(), j.selected.end()}, .move = shift_between(*j.from, *j.to)});
    j.from.reset();
    j.to.reset();
    j.moves = false;
}

}  // namespace tuft::app
