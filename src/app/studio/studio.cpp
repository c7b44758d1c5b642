#include "app/studio/studio.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "app/input/imgui_feed.h"
#include "app/panels/panels.h"
#include "app/session/top_dialog.h"
#include "app/view/model_colours.h"
#include "app/view/tuft_solid.h"
#include "core/files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr double kTurnPause = 0.25;  // seconds without a turn of the wheel after which the view is still
constexpr double kStillAfter = 0.4;  // seconds after the last event
constexpr double kProgressEvery = 0.05, kInkEvery = 0.008, kStillEvery = 0.015;  // seconds between frames
constexpr double kInkWait = 0.02,
                 kInkPart = 0.2;       // seconds, and part of a frame's time, that the newest ink is waited for
constexpr float kLeastView = 240;      // pixels at scale 1, of the model's view beside both panels
constexpr double kPictureAfter = 1.5;  // seconds after the last stroke
constexpr double kPictureWait = 3;     // seconds that leaving waits at most for the newest ink on it

// Micrometres.
double highest_of(std::span<const std::array<std::uint8_t, 4>> texels) {
    std::uint8_t most = 0;
    for (const auto& texel : texels) most = std::max(most, texel[3]);
    return render::height_of_code(most);
}

}  // namespace

Studio::Studio() : scene_(std::make_unique<render::GlScene>()), view_(std::make_unique<render::GlView>()) {
    Session& s = session_;
    s.brush.presets = brush::list_presets();
    s.colours.shipped = ink::list_inks();
    s.colours.substrates = ink::list_substrates();
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(data_folder() / "models", ec))
        if (entry.path().extension() == ".ply") s.project.start_page.samples.push_back(entry.path());
    std::sort(s.project.start_page.samples.begin(), s.project.start_page.samples.end());
    s.project.start_page.recent = recent_projects();
    s.project.recovery.lost = find_lost_work();
    load_colours(s.colours.choice);
    load_settings(s);
    if (const std::string missing = s.ui.prepare(s.preferences.ui); !missing.empty()) show_message(s.status, missing);
    cursor_.x = cursor_.y = -1;
}

Studio::~Studio() {
    finish();
    session_.project.start_page.pictures.release();
}

void Studio::drop_graphics() {
    scene_.reset();
    view_.reset();
    compare_scene_.reset();
    compare_view_.reset();
    for (ReferenceImage& image : session_.view.references.images) image.texture = 0;
    session_.journal.snapshots.texture = 0;
    session_.project.start_page.pictures.release();
}

void Studio::make_graphics() {
    Session& s = session_;
    scene_ = std::make_unique<render::GlScene>();
    view_ = std::make_unique<render::GlView>();
    s.colours.palette.texture = 0;
    s.layers.list.textures.clear();
    for (const auto& [layer, picture] : s.layers.list.pictures) s.layers.list.fresh.insert(layer);
    s.colours.palette.fresh = true;
    colours_shown_ = ModelView::glaze;
    if (s.paint_thread && !s.view.model_changed) {
        const stroke::Model& m = s.paint_thread->model();
        scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
        s.paint_thread->post(SendTexture{});
        if (comparing())
            compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), s.journal.snapshots.compared);
    }
    show_message(s.status, "The graphics driver was reset; the picture was made anew, and no stroke is lost.");
}

void Studio::finish() {
    Session& s = session_;
    if (hand_ && s.paint_thread) post(hand_->lift(), now_);
    hand_.reset();
    if (s.paint_thread && (picture_due_ != 0 || s.journal.lines.size() != strokes_seen_)) {
        s.paint_thread->wait_idle(kPictureWait);
        poll_paint_thread(s);
        take_model();
        draw_scene(framebuffer_, height_);
        picture_due_ = now_;
        keep_picture();
    }
    close_model(s);
}

double Studio::patience() const {
    const Session& s = session_;
    if (s.view.model_changed || !s.view.texels.tiles.empty() || s.preferences.restyle || hand_ || drag_ != Drag::none)
        return 0;
    if (s.project.opening.running() || !s.reported.progress.busy.empty()) return kProgressEvery;
    if (!is_settled(s)) return kInkEvery;
    if (now_ - last_event_ < kStillAfter) return kStillEvery;
    return s.project.start_page.pictures.busy() ? 0.1 : 0.5;
}

void Studio::layout(int width, int height) {
    Session& s = session_;
    const float top = ImGui::GetFrameHeight() + s.ui.px(4);
    // Where there is no room for both, the model is worth more than the list.
    const int strip = static_cast<int>(s.ui.px(kStripWidth));
    const int beside = static_cast<int>(s.ui.px(kToolWidth)), whole = static_cast<int>(s.ui.px(kJournalWidth));
    s.panels.journal_fits = static_cast<float>(width - strip - beside - whole) >= s.ui.px(kLeastView);
    const int tools = strip + (s.panels.show_tools || s.panels.show_appearance ||
                                       (!s.panels.journal_fits && s.panels.journal_over_tools)
                                   ? beside
                                   : 0);
    const int journal = s.panels.journal_fits && s.panels.show_journal ? whole : 0;
    const int left = s.preferences.ui.left_handed ? journal : tools;
    s.view.area = {left, static_cast<int>(top), std::max(16, width - tools - journal),
                   std::max(16, height - static_cast<int>(top) - static_cast<int>(s.ui.px(kStatusHeight)))};
    s.view.atlas.area = {};
    layout_comparison();
    if (!s.view.atlas.shown || !s.paint_thread || comparing()) return;
    s.view.atlas.area = s.view.area;
    s.view.area.width /= 2;
    s.view.atlas.area.x += s.view.area.width + 1;
    s.view.atlas.area.width -= s.view.area.width + 1;
}

void Studio::panels() {
    Session& s = session_;
    menu_bar(s);
    s.ui.modal = is_dialog_open(session_);
    ImGui::BeginDisabled(s.ui.modal);
    if (s.paint_thread) {
        const auto top = static_cast<float>(s.view.area.y),
                   bottom = static_cast<float>(s.view.area.y + s.view.area.height);
        const auto right = static_cast<float>(s.view.atlas.shown ? s.view.atlas.area.x + s.view.atlas.area.width
                                                                 : s.view.area.x + s.view.area.width);
        const bool swapped = !s.panels.journal_fits && s.panels.journal_over_tools && !s.panels.show_appearance;
        const float strip = s.ui.px(kStripWidth), screen = ImGui::GetIO().DisplaySize.x;
        tool_strip(s, top, bottom, s.preferences.ui.left_handed ? screen - strip : 0);
        if (s.panels.show_appearance || s.panels.show_tools || swapped)
            (s.panels.show_appearance ? colours_panel
             : swapped                ? journal_panel
                                      : tool_panel)(s, top, bottom, s.preferences.ui.left_handed ? right : strip);
        if (s.panels.journal_fits && s.panels.show_journal)
            journal_panel(s, top, bottom, s.preferences.ui.left_handed ? 0 : right);
        status_bar(s, bottom);
        panel_handles(s);
        tuft_inset(s);
        update_palette_picture();
        palette_panel(s);
        update_thumbnails();
        colour_panel(s);
        references_over_view(s);
        swipe_line(s);
        comparison_bar(s);
        guide(s);
        view_marks(s, camera());
        atlas_marks(s, atlas_cursor());
    } else {
        welcome(s);
    }
    ImGui::EndDisabled();
    if (s.project.opening.running())
        opening_progress(s);
    else if (s.project.closing.request)
        leave_dialog(s);
    else if (s.project.in_use)
        in_use_dialog(s);
    else if (s.project.inspected)
        open_dialog(s);
    else if (!s.project.recovery.lost.empty() && !s.paint_thread)
        recovery_dialog(s);
    export_dialog(s);
    settings_dialog(s);
    manual_dialog(s);
    keys_dialog(s);
    about_dialog(s);
    mismatch_dialog(s);
    if (const auto path = s.dialogs.file.draw(s.ui, s.project.start_page.pictures)) {
        if (s.dialogs.file.purpose() == FileDialog::Purpose::open)
            open_path(s, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::save)
            save_as(s, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::revise)
            revise_with(s, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::writing)
            open_writing(s, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::reference)
            pin_reference(s.view.references, s.paint_thread.get(), s.status, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::ink)
            open_ink(s.paint_thread.get(), s.status, *path);
        else if (s.dialogs.file.purpose() == FileDialog::Purpose::save_ink)
            save_ink(s.colours, s.brush.ink, s.status, *path);
        else if (s.paint_thread)
            s.paint_thread->post(export_command(s, *path));
    }
}

void Studio::take_model() {
    Session& s = session_;
    if (s.view.model_changed) {
        const stroke::Model& m = s.paint_thread->model();
        hand_.reset();
        line_start_.reset();
        thumbnails_from_.reset();
        s.tools.pointer_down = false;
        scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
        const render::MapPixels pixels = s.paint_thread->take_pixels();
        scene_->set_texture(pixels);
        s.view.max_ink_height = highest_of(pixels.levels[0]);
        view_->scene_changed();
        colours_shown_ = ModelView::glaze;
        if (!std::exchange(s.view.keep_camera, false)) {
            const Orbit fresh;
            s.view.orbit.azimuth = fresh.azimuth;
            s.view.orbit.elevation = fresh.elevation;
            s.view.orbit.roll = 0;
            if (s.view.orbit.parallel_until_turned) s.view.orbit.set_parallel(false);
            s.view.orbit.frame(m.mesh->bounds);
        }
        s.view.model_changed = false;
        strokes_seen_ = s.journal.lines.size();
    }
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
    if (s.journal.lines.size() != strokes_seen_ || (s.reported.file.project != pictured_ && !s.journal.lines.empty())) {
        strokes_seen_ = s.journal.lines.size();
        pictured_ = s.reported.file.project;
        picture_due_ = now_ + kPictureAfter;
    }
}

void Studio::show_colours() {
    Session& s = session_;
    if (s.view.shading == colours_shown_) return;
    if ((colours_shown_ == ModelView::wetness) != (s.view.shading == ModelView::wetness)) {
        s.paint_thread->post(SendTexture{s.view.shading == ModelView::wetness});
        s.view.max_ink_height = 0;
    }
    colours_shown_ = s.view.shading;
    view_->scene_changed();
    const stroke::Model& m = s.paint_thread->model();
    if (s.view.shading == ModelView::charts) scene_->set_triangle_colours(chart_colours(m.atlas));
    if (s.view.shading == ModelView::stretch) scene_->set_triangle_colours(stretch_colours(*m.mesh, m.atlas));
}

void Studio::update_tuft(double now) {
    Session& s = session_;
    s.view.tuft.state = {};
    s.view.tuft.depth = 0;
    const BrushStatus& painting = s.reported.brush;
    s.colours.palette.tuft = painting.on_palette ? painting.tuft : brush::TuftState{};
    s.view.tuft.pressed = !painting.tuft.branches.empty() && !painting.on_palette;
    if (s.view.tuft.pressed) {
        s.view.tuft.state = painting.tuft;
    } else if (s.tools.active != Tool::writing && s.tools.active != Tool::fill && s.tools.active != Tool::pick &&
               s.tools.active != Tool::mask && !s.journal.moves && cursor_inside_ && drag_ == Drag::none &&
               !is_dialog_open(session_)) {
        if (!preview_ || preview_brush_ != s.brush.preset) {
            preview_ = brush::make_tuft(brush::load_preset(s.brush.preset));
            preview_brush_ = s.brush.preset;
        }
        Event at = cursor_;
        at.time = now;
        const PointerInput hand(*s.paint_thread->model().query, preview_->preset, s.tools.pointer);
        if (const auto pose = hand.hover(aim_of(at))) s.view.tuft.state = brush::step(*preview_, *pose, {}, 0.01);
    }
    if (s.view.tuft.state.branches.empty() || !s.view.tuft.pressed) return;
    const brush::Section& root = s.view.tuft.state.branches.front().sections.back();
    double length = 0;
    const auto& sections = s.view.tuft.state.branches.front().sections;
    for (std::size_t i = 1; i < sections.size(); ++i)
        length += glm::distance(sections[i].centre, sections[i - 1].centre);
    const auto hit = s.paint_thread->model().query->ray(root.centre, root.tangent, 0, length);
    if (hit) s.view.tuft.depth = length - hit->distance;
}

void Studio::draw_scene(unsigned framebuffer, int height) {
    Session& s = session_;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_SCISSOR_TEST);
    const float shade = s.ui.settings().theme == Theme::dark ? 0.155f : 0.94f;
    glClearColor(shade, shade, shade, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!s.paint_thread || s.view.model_changed) return;
    show_colours();
    static constexpr render::Shading shadings[] = {
        render::Shading::glaze,  render::Shading::clay,   render::Shading::flat,      render::Shading::height,
        render::Shading::height, render::Shading::texels, render::Shading::triangles, render::Shading::triangles};
    const bool dark = s.ui.settings().theme == Theme::dark;
    const render::GlSolid solid = solid_of(s.view.tuft.state, colour_in_tuft(s));
    render::GlView::Frame f{.camera = camera(),
                            .solid = &solid,
                            .opacity = s.view.see_through    ? 0.25f
                                       : s.view.tuft.pressed ? 0.92f
                                                             : 0.72f};
    f.look.options = {.shading = shadings[static_cast<std::size_t>(s.view.shading)],
                      .roughness = s.colours.appearance.roughness,
                      .section = section_plane(s.view, s.paint_thread->model().mesh->bounds)};
    // Only where it is shown: more ink than before must not draw everything anew.
    if (f.look.options.shading == render::Shading::height)
        f.look.options.height_range = static_cast<float>(height_range(s.view.max_ink_height));
    f.look.light = render::make_light(s.view.rig, f.camera);
    f.look.low = dark ? Vec3f(0.27f) : Vec3f(0.62f);
    f.look.high = dark ? Vec3f(0.40f, 0.405f, 0.415f) : Vec3f(0.80f, 0.805f, 0.815f);
    f.moving = drag_ != Drag::none || now_ - last_turn_ < kTurnPause;
    f.framebuffer = framebuffer;
    f.x = s.view.area.x;
    f.y = height - s.view.area.y - s.view.area.height;
    draw_comparison(f, height);
    view_->draw(*scene_, f);
    draw_atlas(f.look.options, framebuffer, height);
}

void Studio::keep_picture() {
    Session& s = session_;
    if (picture_due_ == 0 || now_ < picture_due_ || !s.paint_thread || s.view.tuft.pressed || !is_settled(s)) return;
    picture_due_ = 0;
    if (s.reported.file.project.empty()) return;
    s.project.start_page.pictures.keep(s.reported.file.project, s.view.area.width, s.view.area.height,
                                       render::read_pixels(s.view.area.x, 0, s.view.area.width, s.view.area.height));
}

// While the hand draws, the ink of its newest samples shall be in this frame and not in the next:
// the painter gets a part of the time that a frame takes, if it keeps up at all.
void Studio::await_ink(double since_last) {
    Session& s = session_;
    s.paint_thread->wait_idle(std::min(kInkWait, kInkPart * since_last));
    poll_paint_thread(s);
    take_model();
}

void Studio::shown(double now) {
    for (; !asked_.empty() && asked_.front() <= session_.reported.progress.done; asked_.pop_front())
        delays_.push_back(now - asked_.front());
}

void Studio::frame(EventQueue& queue, int width, int height, unsigned framebuffer, double now) {
    Session& s = session_;
    const double dt = std::max(1e-3, now - now_);
    now_ = now;
    framebuffer_ = framebuffer;
    height_ = height;
    if (const float scale = scale_for(content_scale_, width, height);
        !s.preferences.ui.own_scale && s.preferences.ui.scale != scale) {
        s.preferences.ui.scale = scale;
        s.preferences.restyle = true;
    }
    if (std::exchange(s.ui.sections_changed, false)) store_settings(s);
    if (s.preferences.restyle) {
        s.preferences.restyle = false;
        if (const std::string missing = s.ui.prepare(s.preferences.ui); !missing.empty())
            show_message(s.status, missing);
        if (s.preferences.ui.language != s.ui.settings().language) {  // there is no font for it
            s.preferences.ui.language = s.ui.settings().language;
            store_settings(s);
        }
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    poll_session(s);
    if (!queue.empty()) last_event_ = now;
    const std::vector<Event> events = feed_imgui(queue, width, height, dt);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    s.ui.begin_frame();
    layout(width, height);
    if (s.paint_thread) take_model();
    const bool keeps_up = s.paint_thread && s.paint_thread->idle();
    for (const Event& event : events) handle(event);
    if (s.paint_thread && hand_ && keeps_up && !events.empty()) await_ink(dt);
    if (s.paint_thread) {
        watch_curve();
        watch_writing();
        update_tuft(now);
    }
    panels();
    s.ui.enter = false;
    if (++frames_ % draw_every_ != 0) return ImGui::EndFrame();
    draw_scene(framebuffer, height);
    keep_picture();
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

render::GlCamera Studio::camera() const {
    const Session& s = session_;
    return s.view.orbit.camera(s.view.area.width, s.view.area.height,
                               s.paint_thread ? s.paint_thread->model().mesh->bounds : Box{{-1, -1, -1}, {1, 1, 1}});
}

}  // namespace tuft::app
