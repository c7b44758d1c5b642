#include "app/studio/scene_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "app/panels/panels.h"
#include "app/session/top_dialog.h"
#include "app/tools/aim.h"
#include "app/view/model_colours.h"
#include "app/view/tuft_solid.h"
#include "brush/tuft/ferrule.h"

namespace tuft::app {
namespace {

// Micrometres.
double highest_of(std::span<const std::array<std::uint8_t, 4>> texels) {
    std::uint8_t most = 0;
    for (const auto& texel : texels) most = std::max(most, texel[3]);
    return render::height_of_code(most);
}

}  // namespace

SceneView::SceneView(Session& session)
    : session_(session),
      comparison_(session),
      scene_(std::make_unique<render::GlScene>()),
      view_(std::make_unique<render::GlView>()) {}

void SceneView::drop_graphics() {
    scene_.reset();
    view_.reset();
    comparison_.drop_graphics();
}

void SceneView::make_graphics() {
    Session& s = session_;
    scene_ = std::make_unique<render::GlScene>();
    view_ = std::make_unique<render::GlView>();
    shading_ = ModelView::glaze;
    if (!s.paint_thread || s.view.model_changed) return;
    const stroke::Model& m = s.paint_thread->model();
    scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
    parts_ = {};
    s.paint_thread->post(SendTexture{});
    SnapshotState& snapshots = s.journal.snapshots;
    if (comparison_.on()) compare_with(snapshots, s.view.atlas, s.paint_thread.get(), std::string(snapshots.compared));
}

void SceneView::take_model() {
    Session& s = session_;
    const stroke::Model& m = s.paint_thread->model();
    scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
    parts_ = {};
    const render::MapPixels pixels = s.paint_thread->take_pixels();
    scene_->set_texture(pixels);
    s.view.max_ink_height = highest_of(pixels.levels[0]);
    view_->scene_changed();
    shading_ = ModelView::glaze;
    if (!std::exchange(s.view.keep_camera, false)) {
        const Orbit fresh;
        Orbit& orbit = s.view.orbit;
        orbit.azimuth = fresh.azimuth;
        orbit.elevation = fresh.elevation;
        orbit.roll = 0;
        if (orbit.parallel_until_turned) orbit.set_parallel(false);
        orbit.frame(m.mesh->bounds);
    }
    s.view.model_changed = false;
}

void SceneView::take_texels() {
    Session& s = session_;
    if (s.view.texels.pixels) {
        scene_->set_texture(*s.view.texels.pixels);
        s.view.max_ink_height = highest_of(s.view.texels.pixels->levels[0]);
        s.view.texels.pixels.reset();
        view_->scene_changed();
    }
    scene_->update_tiles(s.view.texels.tiles);
    for (const render::TilePixels& tile : s.view.texels.tiles)
        s.view.max_ink_height = std::max(s.view.max_ink_height, highest_of(std::span(tile.rgba).first(256)));
    for (const render::TilePixels& tile : s.view.texels.tiles) view_->texture_changed(tile.boxes);
    s.view.texels.tiles.clear();
}

void SceneView::take_parts() {
    const Session& s = session_;
    const Appearance& shown = s.colours.appearance;
    PartLook look{.parts = s.reported.document.parts,
                  .transmission = shown.document.transmission,
                  .is_preview = shown.is_preview};
    if (look == parts_) return;
    stroke::PartTable table = look.parts;
    if (shown.is_preview)
        for (stroke::Part& part : table.parts) part.substrate.reset();
    stroke::PartSet parts(s.paint_thread->model());
    parts.set_table(std::move(table));
    scene_->set_parts(parts.hidden_triangles(), parts.transmission(shown.document));
    view_->scene_changed();
    parts_ = std::move(look);
}

void SceneView::show_triangle_colours() {
    Session& s = session_;
    if (s.view.shading == shading_) return;
    if ((shading_ == ModelView::wetness) != (s.view.shading == ModelView::wetness)) {
        s.paint_thread->post(SendTexture{s.view.shading == ModelView::wetness});
        s.view.max_ink_height = 0;
    }
    shading_ = s.view.shading;
    view_->scene_changed();
    const stroke::Model& m = s.paint_thread->model();
    if (s.view.shading == ModelView::charts) scene_->set_triangle_colours(chart_colours(m.atlas));
    if (s.view.shading == ModelView::stretch) scene_->set_triangle_colours(stretch_colours(*m.mesh, m.atlas));
}

void SceneView::choose_preview() {
    const Session& s = session_;
    if (preview_ && preview_brush_ == s.brush.preset) return;
    preview_ = brush::make_tuft(brush::load_preset(s.brush.preset));
    preview_brush_ = s.brush.preset;
}

void SceneView::hover(const brush::Pose& pose) {
    TuftView& view = session_.view.tuft;
    choose_preview();
    view.state = brush::step(*preview_, pose, {}, 0.01);
    view.pose = pose;
    view.mouth = brush::mouth_outline(preview_->preset);
}

void SceneView::update_tuft(const Event* cursor, const std::optional<brush::Pose>& guided, double now) {
    Session& s = session_;
    s.view.tuft.state = {};
    s.view.tuft.depth = 0;
    const BrushStatus& painting = s.reported.brush;
    s.colours.palette.tuft = painting.on_palette ? painting.tuft : brush::TuftState{};
    s.view.tuft.pressed = !painting.tuft.branches.empty() && !painting.on_palette;
    if (s.view.tuft.pressed) {
        s.view.tuft.state = painting.tuft;
        preview_brush_.clear();  // its file may be another by the next stroke
    } else if (guided) {
        hover(*guided);
    } else if (s.tools.active != Tool::writing && s.tools.active != Tool::text && s.tools.active != Tool::fill &&
               s.tools.active != Tool::pick && s.tools.active != Tool::mask && !s.journal.move_on_drag && cursor &&
               !is_dialog_open(s)) {
        choose_preview();
        Event at = *cursor;
        at.time = now;
        const PointerInput hand(s.paint_thread->surface(), preview_->preset, s.tools.pointer);
        if (const auto pose = hand.hover(aim_of(s, at))) hover(*pose);
    }
    if (s.view.tuft.state.branches.empty() || !s.view.tuft.pressed) return;
    const brush::Section& root = s.view.tuft.state.branches.front().sections.back();
    double length = 0;
    const auto& sections = s.view.tuft.state.branches.front().sections;
    for (std::size_t i = 1; i < sections.size(); ++i)
        length += glm::distance(sections[i].centre, sections[i - 1].centre);
    const auto hit = s.paint_thread->surface().ray(root.centre, root.tangent, 0, length);
    if (hit) s.view.tuft.depth = length - hit->distance;
}

void SceneView::draw(unsigned framebuffer, int height, bool moving) {
    Session& s = session_;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_SCISSOR_TEST);
    const float shade = s.ui.settings().theme == Theme::dark ? 0.155f : 0.94f;
    glClearColor(shade, shade, shade, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!s.paint_thread || s.view.model_changed) return;
    take_parts();
    show_triangle_colours();
    static constexpr render::Shading shadings[] = {
        render::Shading::glaze,  render::Shading::clay,   render::Shading::flat,      render::Shading::height,
        render::Shading::height, render::Shading::texels, render::Shading::triangles, render::Shading::triangles};
    const bool dark = s.ui.settings().theme == Theme::dark;
    const render::GlSolid solid = solid_of(s.view.tuft.state, colour_in_tuft(s.brush, s.colours, s.reported.brush));
    render::GlView::Frame f{.camera = camera_of(s),
                            .solid = &solid,
                            .opacity = s.view.see_through    ? 0.25f
                                       : s.view.tuft.pressed ? 0.92f
                                                             : 0.72f};
    f.appearance.options = {.shading = shadings[static_cast<std::size_t>(s.view.shading)],
                            .roughness = s.colours.appearance.roughness,
                            .section = section_plane(s.view, s.paint_thread->model().mesh->bounds)};
    // Only where it is shown: more ink than before must not draw everything anew.
    if (f.appearance.options.shading == render::Shading::height)
        f.appearance.options.height_range = static_cast<float>(height_range(s.view.max_ink_height));
    f.appearance.light = render::make_light(s.view.rig, f.camera);
    f.appearance.low = dark ? Vec3f(0.27f) : Vec3f(0.62f);
    f.appearance.high = dark ? Vec3f(0.40f, 0.405f, 0.415f) : Vec3f(0.80f, 0.805f, 0.815f);
    f.moving = moving;
    f.framebuffer = framebuffer;
    f.x = s.view.area.x;
    f.y = height - s.view.area.y - s.view.area.height;
    comparison_.draw(f, height);
    view_->draw(*scene_, f);
    draw_atlas(f.appearance.options, framebuffer, height);
}

void SceneView::draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height) {
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

}  // namespace tuft::app
