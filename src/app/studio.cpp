#include "app/studio.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "app/input/imgui_feed.h"
#include "app/panels/panels.h"
#include "app/view/model_colours.h"
#include "core/system/files.h"

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
    s.brushes = brush::list_presets();
    s.inks = ink::list_inks();
    s.substrates = ink::list_substrates();
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(data_folder() / "models", ec))
        if (entry.path().extension() == ".ply") s.samples.push_back(entry.path());
    std::sort(s.samples.begin(), s.samples.end());
    s.recent = recent_projects();
    s.lost = find_lost_work();
    load_colours(s.colour);
    load_settings(s);
    if (const std::string missing = s.ui.prepare(s.wanted); !missing.empty()) say(s, missing);
    cursor_.x = cursor_.y = -1;
}

Studio::~Studio() {
    finish();
    session_.pictures.release();
}

void Studio::drop_graphics() {
    scene_.reset();
    view_.reset();
    compare_scene_.reset();
    compare_view_.reset();
    for (ReferenceImage& image : session_.references.images) image.texture = 0;
    session_.snapshots.texture = 0;
    session_.pictures.release();
}

void Studio::make_graphics() {
    Session& s = session_;
    scene_ = std::make_unique<render::GlScene>();
    view_ = std::make_unique<render::GlView>();
    s.palette.texture = 0;
    s.layer_list.textures.clear();
    for (const auto& [layer, picture] : s.layer_list.pictures) s.layer_list.fresh.insert(layer);
    s.palette.fresh = true;
    colours_shown_ = ModelView::glaze;
    if (s.painter && !s.model_is_new) {
        const stroke::Model& m = s.painter->model();
        scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
        s.painter->post(SendTexture{});
        if (comparing()) compare_with(s, s.snapshots.compared);
    }
    say(s, "The graphics driver was reset; the picture was made anew, and no stroke is lost.");
}

void Studio::finish() {
    Session& s = session_;
    if (hand_ && s.painter) post(hand_->lift(), now_);
    hand_.reset();
    if (s.painter && (picture_due_ != 0 || s.strokes.size() != strokes_seen_)) {
        s.painter->wait_idle(kPictureWait);
        poll_painter(s);
        take_model();
        draw_scene(framebuffer_, height_);
        picture_due_ = now_;
        keep_picture();
    }
    close_model(s);
}

double Studio::patience() const {
    const Session& s = session_;
    if (s.model_is_new || !s.last.tiles.empty() || s.restyle || hand_ || drag_ != Drag::none) return 0;
    if (s.opening.running() || !s.last.busy.empty()) return kProgressEvery;
    if (!settled(s)) return kInkEvery;
    if (now_ - last_event_ < kStillAfter) return kStillEvery;
    return s.pictures.busy() ? 0.1 : 0.5;
}

void Studio::layout(int width, int height) {
    Session& s = session_;
    const float top = ImGui::GetFrameHeight() + s.ui.px(4);
    // Where there is no room for both, the model is worth more than the list.
    const int strip = static_cast<int>(s.ui.px(kStripWidth));
    const int beside = static_cast<int>(s.ui.px(kToolWidth)), whole = static_cast<int>(s.ui.px(kJournalWidth));
    s.journal_fits = static_cast<float>(width - strip - beside - whole) >= s.ui.px(kLeastView);
    const int tools = strip + (s.tools_shown || s.show_colours || (!s.journal_fits && s.show_journal) ? beside : 0);
    const int journal = s.journal_fits && s.journal_shown ? whole : 0;
    const int left = s.wanted.left_handed ? journal : tools;
    s.area = {left, static_cast<int>(top), std::max(16, width - tools - journal),
              std::max(16, height - static_cast<int>(top) - static_cast<int>(s.ui.px(kStatusHeight)))};
    s.atlas_area = {};
    layout_comparison();
    if (!s.view.atlas || !s.painter || comparing()) return;
    s.atlas_area = s.area;
    s.area.width /= 2;
    s.atlas_area.x += s.area.width + 1;
    s.atlas_area.width -= s.area.width + 1;
}

bool Studio::dialog_open() const {
    const Session& s = session_;
    return s.inspected || s.opening.running() || (!s.lost.empty() && !s.painter) || s.show_export || s.show_settings ||
           s.show_keys || s.show_about || s.help.manual || s.show_mismatches || s.in_use || s.leaving ||
           s.files.shown();
}

void Studio::panels() {
    Session& s = session_;
    menu_bar(s);
    s.ui.modal = dialog_open();
    ImGui::BeginDisabled(s.ui.modal);
    if (s.painter) {
        const auto top = static_cast<float>(s.area.y), bottom = static_cast<float>(s.area.y + s.area.height);
        const auto right =
            static_cast<float>(s.view.atlas ? s.atlas_area.x + s.atlas_area.width : s.area.x + s.area.width);
        const bool swapped = !s.journal_fits && s.show_journal && !s.show_colours;
        const float strip = s.ui.px(kStripWidth), screen = ImGui::GetIO().DisplaySize.x;
        tool_strip(s, top, bottom, s.wanted.left_handed ? screen - strip : 0);
        if (s.show_colours || s.tools_shown || swapped)
            (s.show_colours ? colours_panel
             : swapped      ? journal_panel
                            : tool_panel)(s, top, bottom, s.wanted.left_handed ? right : strip);
        if (s.journal_fits && s.journal_shown) journal_panel(s, top, bottom, s.wanted.left_handed ? 0 : right);
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
    if (s.opening.running())
        opening_progress(s);
    else if (s.leaving)
        leave_dialog(s);
    else if (s.in_use)
        in_use_dialog(s);
    else if (s.inspected)
        open_dialog(s);
    else if (!s.lost.empty() && !s.painter)
        recovery_dialog(s);
    export_dialog(s);
    settings_dialog(s);
    manual_dialog(s);
    keys_dialog(s);
    about_dialog(s);
    mismatch_dialog(s);
    if (const auto path = s.files.draw(s.ui, s.pictures)) {
        if (s.files.purpose() == FileDialog::Purpose::open)
            open_path(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::save)
            save_as(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::revise)
            revise_with(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::writing)
            open_writing(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::reference)
            pin_reference(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::ink)
            open_ink(s, *path);
        else if (s.files.purpose() == FileDialog::Purpose::save_ink)
            save_ink(s, *path);
        else if (s.painter)
            s.painter->post(export_command(s, *path));
    }
}

void Studio::take_model() {
    Session& s = session_;
    if (s.model_is_new) {
        const stroke::Model& m = s.painter->model();
        hand_.reset();
        line_start_.reset();
        thumbnails_from_.reset();
        s.hand_down = false;
        scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
        const render::MapPixels pixels = s.painter->take_pixels();
        scene_->set_texture(pixels);
        s.highest = highest_of(pixels.levels[0]);
        view_->scene_changed();
        colours_shown_ = ModelView::glaze;
        if (!std::exchange(s.keeps_view, false)) {
            const Orbit fresh;
            s.view.orbit.azimuth = fresh.azimuth;
            s.view.orbit.elevation = fresh.elevation;
            s.view.orbit.roll = 0;
            if (s.view.orbit.parallel_until_turned) s.view.orbit.set_parallel(false);
            s.view.orbit.frame(m.mesh->bounds);
        }
        s.model_is_new = false;
        strokes_seen_ = s.strokes.size();
    }
    if (s.last.pixels) {
        scene_->set_texture(*s.last.pixels);
        s.highest = highest_of(s.last.pixels->levels[0]);
        s.last.pixels.reset();
        view_->scene_changed();
    }
    scene_->update_tiles(s.last.tiles);
    for (const render::TilePixels& tile : s.last.tiles)
        s.highest = std::max(s.highest, highest_of(std::span(tile.rgba).first(256)));
    for (const render::TilePixels& tile : s.last.tiles) view_->texture_changed(tile.boxes);
    s.last.tiles.clear();
    if (s.strokes.size() != strokes_seen_ || (s.last.project != pictured_ && !s.strokes.empty())) {
        strokes_seen_ = s.strokes.size();
        pictured_ = s.last.project;
        picture_due_ = now_ + kPictureAfter;
    }
}

void Studio::show_colours() {
    Session& s = session_;
    if (s.view.shown == colours_shown_) return;
    if ((colours_shown_ == ModelView::wetness) != (s.view.shown == ModelView::wetness)) {
        s.painter->post(SendTexture{s.view.shown == ModelView::wetness});
        s.highest = 0;
    }
    colours_shown_ = s.view.shown;
    view_->scene_changed();
    const stroke::Model& m = s.painter->model();
    if (s.view.shown == ModelView::charts) scene_->set_triangle_colours(chart_colours(m.atlas));
    if (s.view.shown == ModelView::stretch) scene_->set_triangle_colours(stretch_colours(*m.mesh, m.atlas));
}

void Studio::update_tuft(double now) {
    Session& s = session_;
    s.tuft = {};
    s.depth = 0;
    s.palette.tuft = s.last.on_palette && s.last.tuft ? *s.last.tuft : brush::TuftState{};
    s.pressed = s.last.tuft && !s.last.tuft->branches.empty() && !s.last.on_palette;
    if (s.pressed) {
        s.tuft = *s.last.tuft;
    } else if (s.tool != Tool::writing && s.tool != Tool::fill && s.tool != Tool::pick && s.tool != Tool::mask &&
               !s.journal.moves && cursor_inside_ && drag_ == Drag::none && !dialog_open()) {
        if (!preview_ || preview_brush_ != s.brush) {
            preview_ = brush::make_tuft(brush::load_preset(s.brush));
            preview_brush_ = s.brush;
        }
        Event at = cursor_;
        at.time = now;
        const PointerInput hand(*s.painter->model().query, preview_->preset, s.hand);
        if (const auto pose = hand.hover(aim_of(at))) s.tuft = brush::step(*preview_, *pose, {}, 0.01);
    }
    if (s.tuft.branches.empty() || !s.pressed) return;
    const brush::Section& root = s.tuft.branches.front().sections.back();
    double length = 0;
    const auto& sections = s.tuft.branches.front().sections;
    for (std::size_t i = 1; i < sections.size(); ++i)
        length += glm::distance(sections[i].centre, sections[i - 1].centre);
    const auto hit = s.painter->model().query->ray(root.centre, root.tangent, 0, length);
    if (hit) s.depth = length - hit->distance;
}

void Studio::draw_scene(unsigned framebuffer, int height) {
    Session& s = session_;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_SCISSOR_TEST);
    const float shade = s.ui.settings().theme == Theme::dark ? 0.155f : 0.94f;
    glClearColor(shade, shade, shade, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!s.painter || s.model_is_new) return;
    show_colours();
    static constexpr render::Shading shadings[] = {
        render::Shading::glaze,  render::Shading::clay,   render::Shading::flat,      render::Shading::height,
        render::Shading::height, render::Shading::texels, render::Shading::triangles, render::Shading::triangles};
    const bool dark = s.ui.settings().theme == Theme::dark;
    const render::GlSolid solid = solid_of(s.tuft, colour_in_tuft(s));
    render::GlView::Frame f{.camera = camera(),
                            .solid = &solid,
                            .opacity = s.view.see_through ? 0.25f
                                       : s.pressed        ? 0.92f
                                                          : 0.72f};
    f.look.options = {.shading = shadings[static_cast<std::size_t>(s.view.shown)],
                      .roughness = s.looks.roughness,
                      .section = section_plane(s)};
    // Only where it is shown: more ink than before must not draw everything anew.
    if (f.look.options.shading == render::Shading::height)
        f.look.options.height_range = static_cast<float>(height_range(s));
    f.look.light = render::make_light(s.view.rig, f.camera);
    f.look.low = dark ? Vec3f(0.27f) : Vec3f(0.62f);
    f.look.high = dark ? Vec3f(0.40f, 0.405f, 0.415f) : Vec3f(0.80f, 0.805f, 0.815f);
    f.moving = drag_ != Drag::none || now_ - last_turn_ < kTurnPause;
    f.framebuffer = framebuffer;
    f.x = s.area.x;
    f.y = height - s.area.y - s.area.height;
    draw_comparison(f, height);
    view_->draw(*scene_, f);
    draw_atlas(f.look.options, framebuffer, height);
}

void Studio::keep_picture() {
    Session& s = session_;
    if (picture_due_ == 0 || now_ < picture_due_ || !s.painter || s.pressed || !settled(s)) return;
    picture_due_ = 0;
    if (s.last.project.empty()) return;
    s.pictures.keep(s.last.project, s.area.width, s.area.height,
                    render::read_pixels(s.area.x, 0, s.area.width, s.area.height));
}

// While the hand draws, the ink of its newest samples shall be in this frame and not in the next:
// the painter gets a part of the time that a frame takes, if it keeps up at all.
void Studio::await_ink(double since_last) {
    Session& s = session_;
    s.painter->wait_idle(std::min(kInkWait, kInkPart * since_last));
    poll_painter(s);
    take_model();
}

void Studio::shown(double now) {
    for (; !asked_.empty() && asked_.front() <= session_.last.done; asked_.pop_front())
        delays_.push_back(now - asked_.front());
}

void Studio::frame(EventQueue& queue, int width, int height, unsigned framebuffer, double now) {
    Session& s = session_;
    const double dt = std::max(1e-3, now - now_);
    now_ = now;
    framebuffer_ = framebuffer;
    height_ = height;
    if (const float scale = scale_for(content_scale_, width, height); !s.wanted.own_scale && s.wanted.scale != scale) {
        s.wanted.scale = scale;
        s.restyle = true;
    }
    if (std::exchange(s.ui.sections_changed, false)) store_settings(s);
    if (s.restyle) {
        s.restyle = false;
        if (const std::string missing = s.ui.prepare(s.wanted); !missing.empty()) say(s, missing);
        if (s.wanted.language != s.ui.settings().language) {  // there is no font for it
            s.wanted.language = s.ui.settings().language;
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
    if (s.painter) take_model();
    const bool keeps_up = s.painter && s.painter->idle();
    for (const Event& event : events) handle(event);
    if (s.painter && hand_ && keeps_up && !events.empty()) await_ink(dt);
    if (s.painter) {
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
    return s.view.orbit.camera(s.area.width, s.area.height,
                               s.painter ? s.painter->model().mesh->bounds : Box{{-1, -1, -1}, {1, 1, 1}});
}

}  // namespace tuft::app
