#include "app/studio/studio.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/dialogs/dialogs.h"
#include "app/input/imgui_feed.h"
#include "app/panels/panels.h"
#include "app/session/top_dialog.h"
#include "app/studio/set_by_name.h"
#include "app/studio/uploads.h"
#include "app/tools/aim.h"
#include "app/tools/atlas_input.h"
#include "brush/preset/preset.h"
#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr double kTurnPause = 0.25;  // seconds without a turn of the wheel after which the view is still
constexpr double kStill = 0.4;       // seconds without a turn after which the layers' pictures are drawn anew
constexpr double kStillAfter = 0.4;  // seconds after the last event
constexpr double kProgressEvery = 0.05, kInkEvery = 0.008, kStillEvery = 0.015;  // seconds between frames
// Seconds, and part of a frame's time, that the newest ink is waited for.
constexpr double kInkWait = 0.02, kInkPart = 0.2;
constexpr float kLeastView = 340;   // pixels at scale 1, of the model's view beside both panels
constexpr double kPictureWait = 3;  // seconds that leaving waits at most for the newest ink on it

}  // namespace

Studio::Studio() : scene_(session_), input_(session_, scene_.comparison()), picture_(session_) {
    Session& s = session_;
    s.brush.presets = brush::list_presets();
    for (std::string& file : remembered_own_brushes()) s.brush.presets.push_back(std::move(file));
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
    if (const Message missing = s.ui.prepare(s.preferences.ui); !missing.empty()) show_message(s.status, missing);
}

Studio::~Studio() {
    finish();
    session_.project.start_page.pictures.release();
    session_.brush.tried.release();
    release(session_.tools.lettering.copy.texture);
}

void Studio::set(const std::string& name, const std::string& value) {
    set_by_name(session_, name, value);
}

void Studio::drop_graphics() {
    scene_.drop_graphics();
    for (ReferenceImage& image : session_.view.references.images) image.texture = 0;
    session_.journal.snapshots.texture = 0;
    session_.project.start_page.pictures.release();
    session_.brush.tried.release();
    session_.tools.lettering.copy.texture = 0;
    session_.tools.lettering.copy.fresh = true;
}

void Studio::make_graphics() {
    Session& s = session_;
    s.colours.palette.texture = 0;
    s.colours.palette.fresh = true;
    s.layers.list.textures.clear();
    for (const auto& [layer, picture] : s.layers.list.pictures) s.layers.list.fresh.insert(layer);
    scene_.make_graphics();
    show_message(s.status, "The graphics driver was reset; the picture was made anew, and no stroke is lost.");
}

void Studio::finish() {
    Session& s = session_;
    input_.stroke().lift(now_);
    disconnect_arm(s.arm, s.paint_thread.get());
    if (s.paint_thread && picture_.outdated()) {
        s.paint_thread->wait_idle(kPictureWait);
        poll_paint_thread(s);
        take_work();
        scene_.draw(output_.framebuffer, output_.height, false);
        picture_.store(now_, true);
    }
    close_model(s);
}

double Studio::patience() const {
    const Session& s = session_;
    const bool moves = input_.stroke().drawing() || input_.turning();
    if (s.view.model_changed || !s.view.texels.tiles.empty() || s.preferences.restyle || moves) return 0;
    if (s.project.opening.running() || !s.reported.progress.busy.empty()) return kProgressEvery;
    if (!is_settled(s) || s.arm.arm) return kInkEvery;
    if (now_ - last_event_ < kStillAfter) return kStillEvery;
    return s.project.start_page.pictures.busy() || s.brush.tried.busy() ? 0.1 : 0.5;
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
    const int below = static_cast<int>(top) + (s.paint_thread ? static_cast<int>(s.ui.px(kOptionsHeight)) : 0);
    s.view.area = {left, below, std::max(16, width - tools - journal),
                   std::max(16, height - below - static_cast<int>(s.ui.px(kStatusHeight)))};
    s.view.atlas.area = {};
    scene_.comparison().layout();
    if (!s.view.atlas.shown || !s.paint_thread || scene_.comparison().on()) return;
    s.view.atlas.area = s.view.area;
    s.view.area.width /= 2;
    s.view.atlas.area.x += s.view.area.width + 1;
    s.view.atlas.area.width -= s.view.area.width + 1;
}

void Studio::draw_panels() {
    Session& s = session_;
    take_menu(menu_bar({s.ui, s.panels, s.dialogs, s.view, s.colours.palette, s.brush, s.status, s.preferences.keys,
                        s.paint_thread.get(), s.reported, !s.project.revision.previous.empty(), s.arm}));
    s.ui.modal = is_dialog_open(s);
    ImGui::BeginDisabled(s.ui.modal);
    if (s.paint_thread)
        draw_side_panels();
    else
        welcome(s);
    ImGui::EndDisabled();
    draw_dialogs();
}

void Studio::take_menu(MenuChoice choice) {
    Session& s = session_;
    switch (choice) {
        case MenuChoice::none:
            return;
        case MenuChoice::close_model:
            return request_close(s, {CloseRequest::Then::close, {}});
        case MenuChoice::quit:
            return request_close(s, {});
        case MenuChoice::former_model:
            return open_previous(s);
        case MenuChoice::fold_panels:
            return fold_panels(s);
        case MenuChoice::store_settings:
            return store_settings(s);
        case MenuChoice::other_language: {
            UiSettings& ui = s.preferences.ui;
            ui.language = ui.language == Language::english ? Language::chinese : Language::english;
            s.preferences.restyle = true;
            return store_settings(s);
        }
    }
}

void Studio::draw_journal(float top, float bottom, float left) {
    Session& s = session_;
    Ui& ui = s.ui;
    PaintThread& work = *s.paint_thread;
    begin_side_panel(ui, "###journal", {left, top, bottom, kJournalWidth});
    if (!s.panels.journal_fits &&
        ui.primary_button("Back to the tools", ImGui::GetContentRegionAvail().x / ui.settings().scale))
        s.panels.journal_over_tools = false;
    history_buttons({ui, work, s.reported, s.preferences.keys});
    layers_section({ui, s.layers, work, s.reported.document.layers, s.status, s.reported.file.viewing});
    parts_section({ui, s.parts, work, s.reported, s.colours});
    references_section(s);
    snapshots_section(s);
    journal_section(
        {ui, s.journal, work, s.colours, s.brush.presets, s.preferences.keys, s.view.orbit, s.reported.file.viewing});
    ImGui::End();
}

void Studio::draw_side_panels() {
    Session& s = session_;
    const float options = s.ui.px(kOptionsHeight);
    const auto top = static_cast<float>(s.view.area.y) - options,
               bottom = static_cast<float>(s.view.area.y + s.view.area.height);
    const auto right = static_cast<float>(s.view.atlas.shown ? s.view.atlas.area.x + s.view.atlas.area.width
                                                             : s.view.area.x + s.view.area.width);
    const bool swapped = !s.panels.journal_fits && s.panels.journal_over_tools && !s.panels.show_appearance;
    const float strip = s.ui.px(kStripWidth), screen = ImGui::GetIO().DisplaySize.x;
    const bool left_handed = s.preferences.ui.left_handed;
    tool_strip(s, top, bottom, left_handed ? screen - strip : 0);
    const float beside = left_handed ? right : strip;
    if (s.panels.show_appearance)
        colours_panel(s, top, bottom, beside);
    else if (swapped)
        draw_journal(top, bottom, beside);
    else if (s.panels.show_tools)
        tool_panel(s, top, bottom, beside);
    if (s.panels.journal_fits && s.panels.show_journal) draw_journal(top, bottom, left_handed ? 0 : right);
    const auto left = static_cast<float>(s.journal.snapshots.width > 0 ? s.journal.snapshots.x : s.view.area.x);
    tool_options({s.ui, s.tools, s.brush, s.status}, left, top, right - left);
    status_bar(s, bottom);
    panel_handles(s);
    tuft_inset(s);
    upload_palette(s.colours.palette);
    palette_panel(s);
    const bool still = !input_.stroke().drawing() && !input_.turned_within(kStill, now_);
    upload_thumbnails(s, still);
    colour_panel(s);
    lettering_panel(s);
    copied_strokes_panel(s);
    brush_browser(s);
    arm_panel(s);
    references_over_view(s);
    swipe_line(s);
    comparison_bar(s);
    guide(s);
    view_marks({s.ui, s.view, s.tools, s.journal, s.masks, s.paint_thread->model(), s.paint_thread->surface()},
               camera_of(s));
    arm_marks(s, camera_of(s));
    atlas_marks(s.ui, s.view.atlas, *s.paint_thread, atlas_cursor(s, input_.cursor()));
}

void Studio::draw_dialogs() {
    Session& s = session_;
    if (s.project.opening.running())
        opening_progress(s);
    else if (s.project.closing.request)
        unsaved_work_dialog(s);
    else if (s.project.in_use)
        in_use_dialog(s);
    else if (s.project.inspected)
        open_dialog(s);
    else if (!s.project.recovery.lost.empty() && !s.paint_thread)
        recovery_dialog(s);
    export_dialog(s);
    decals_dialog(s);
    film_dialog(s);
    settings_dialog(s);
    manual_dialog(s.ui, s.panels.help, s.dialogs, s.preferences.keys);
    keys_dialog(s);
    about_dialog(s.ui, s.dialogs);
    mismatch_dialog(s);
    if (const auto path = s.dialogs.file.draw(s.ui, s.project.start_page.pictures)) take_file(*path);
}

// What was chosen in the file dialog.
void Studio::take_file(const fs::path& path) {
    Session& s = session_;
    switch (s.dialogs.file.purpose()) {
        case FileDialog::Purpose::open:
            return open_path(s, path);
        case FileDialog::Purpose::save:
            return save_as(s, path);
        case FileDialog::Purpose::revise:
            return revise_with(s, path);
        case FileDialog::Purpose::writing:
            return open_writing(s, path);
        case FileDialog::Purpose::glyphs:
            s.tools.lettering.wanted.glyphs = glyphs_beside(path);
            return;
        case FileDialog::Purpose::brush:
            return open_brush(s, path);
        case FileDialog::Purpose::copied_picture:
            return copy_picture(s.tools.lettering, path);
        case FileDialog::Purpose::save_copy:
            return save_copy(s, path);
        case FileDialog::Purpose::reference:
            return pin_reference(s, path);
        case FileDialog::Purpose::ink:
            return open_ink(s.paint_thread.get(), s.status, path);
        case FileDialog::Purpose::save_ink:
            return save_ink(s.colours, s.brush.ink, s.status, path);
        case FileDialog::Purpose::arm_recording:
            s.arm.settings.recording = path;
            return;
        case FileDialog::Purpose::decals:
            if (s.paint_thread)
                s.paint_thread->post(sheets_command(s.dialogs.decal_settings, s.reported.document.masks, path));
            return;
        case FileDialog::Purpose::film:
            if (s.paint_thread) s.paint_thread->post(film_command(s.dialogs.film_settings, s.view.orbit, path));
            return;
        case FileDialog::Purpose::export_model:
            if (s.paint_thread) s.paint_thread->post(export_command(s.dialogs.export_settings, s.view.orbit, path));
    }
}

// What the paint thread has for the picture.
void Studio::take_work() {
    Session& s = session_;
    if (s.view.model_changed) {
        input_.drop();
        s.layers.list.seen_from.reset();
        scene_.take_model();
        picture_.reset();
    }
    scene_.take_texels();
    picture_.watch(now_);
}

// While the hand draws, the ink of its newest samples shall be in this frame and not in the next:
// the paint thread gets a part of the time that a frame takes, if it keeps up at all.
void Studio::await_ink(double since_last) {
    Session& s = session_;
    s.paint_thread->wait_idle(std::min(kInkWait, kInkPart * since_last));
    poll_paint_thread(s);
    take_work();
}

void Studio::restyle(int width, int height) {
    Session& s = session_;
    Preferences& p = s.preferences;
    if (const float scale = scale_for(content_scale_, width, height); !p.ui.own_scale && p.ui.scale != scale) {
        p.ui.scale = scale;
        p.restyle = true;
    }
    if (std::exchange(s.ui.sections_changed, false)) store_settings(s);
    if (!std::exchange(p.restyle, false)) return;
    if (const Message missing = s.ui.prepare(p.ui); !missing.empty()) show_message(s.status, missing);
    if (p.ui.language != s.ui.settings().language) {  // there is no font for it
        p.ui.language = s.ui.settings().language;
        store_settings(s);
    }
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Studio::frame(EventQueue& queue, const Output& output, double now) {
    Session& s = session_;
    const double dt = std::max(1e-3, now - now_);
    const int width = output.width, height = output.height;
    now_ = now;
    output_ = output;
    restyle(width, height);
    poll_session(s);
    if (!queue.empty()) last_event_ = now;
    const std::vector<Event> events = feed_imgui(queue, width, height, dt);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    s.ui.begin_frame();
    layout(width, height);
    if (s.paint_thread) take_work();
    const bool keeps_up = s.paint_thread && s.paint_thread->idle();
    for (const Event& event : events) input_.handle(event, now);
    if (s.paint_thread && input_.stroke().drawing() && keeps_up && !events.empty()) await_ink(dt);
    if (s.paint_thread) {
        input_.watch(now);
        scene_.update_tuft(input_.turning() ? nullptr : input_.cursor(), input_.arm().hover(), now);
    }
    draw_panels();
    s.ui.enter = false;
    ImGui::Render();
    if (s.ui.lacks_characters(*ImGui::GetDrawData())) s.preferences.restyle = true;
    if (!output.seen) return;
    scene_.draw(output.framebuffer, height, input_.turned_within(kTurnPause, now));
    picture_.store(now);
    glBindFramebuffer(GL_FRAMEBUFFER, output.framebuffer);
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace tuft::app
