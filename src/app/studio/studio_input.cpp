#include "app/studio/studio_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/session/open_close.h"
#include "app/session/settings_file.h"
#include "app/session/top_dialog.h"
#include "app/tools/aim.h"
#include "app/tools/atlas_input.h"
#include "app/tools/model_clicks.h"
#include "app/tools/palette_input.h"
#include "brush/preset/preset.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

constexpr double kTurnPixels = 1.0;
constexpr double kRollStep = 5 * kDegree;  // of a key, and of a step of the wheel

/// Turns the holder of a wide ferrule by so many steps, anticlockwise.
void roll_holder(PointerSettings& pointer, double steps) {
    pointer.roll = std::remainder(pointer.roll + steps * kRollStep, 360 * kDegree);
}

}  // namespace

StudioInput::StudioInput(Session& session, const Comparison& comparison)
    : session_(session),
      comparison_(comparison),
      stroke_(session, tip_lag_),
      curve_(session, tip_lag_),
      writing_(session),
      lettering_(session),
      arm_(session) {
    cursor_.x = cursor_.y = -1;
}

void StudioInput::drop() {
    stroke_.drop();
    curve_.drop();
}

void StudioInput::watch(double now) {
    curve_.watch(cursor());
    writing_.watch(cursor());
    lettering_.watch(cursor());
    arm_.update(now, stroke_.drawing());
}

void StudioInput::handle(const Event& e, double now) {
    Session& s = session_;
    now_ = now;
    switch (e.kind) {
        case Event::Kind::drop:
            open_path(s, e.text);
            return;
        case Event::Kind::key_down:
            key(e);
            return;
        case Event::Kind::press:
            press(e);
            break;
        case Event::Kind::move:
            move(e);
            break;
        case Event::Kind::release:
            release(e);
            break;
        case Event::Kind::fly:
            fly(e);
            return;
        case Event::Kind::cap_button:
            s.preferences.space_mouse.seen = true;
            if (s.paint_thread && !is_dialog_open(s)) perform(e.button == 0 ? Action::frame_all : Action::frame_cursor);
            return;
        case Event::Kind::focus:
        case Event::Kind::focus_lost:
            s.arm.focused = e.kind == Event::Kind::focus;
            return;
        case Event::Kind::hover_end:
            inside_ = false;
            return;
        case Event::Kind::scroll:
            scroll(e);
            return;
        default:
            return;
    }
    if (e.pressure >= 0) s.tools.pen_pressure = e.pressure;
    cursor_ = e;
    inside_ = !ImGui::GetIO().WantCaptureMouse && e.x >= s.view.area.x && e.y >= s.view.area.y &&
              e.x < s.view.area.x + s.view.area.width && e.y < s.view.area.y + s.view.area.height;
}

void StudioInput::scroll(const Event& e) {
    Session& s = session_;
    if (!s.paint_thread || ImGui::GetIO().WantCaptureMouse) return;
    if (in_atlas(s.view.atlas, e)) return zoom_atlas(s.view.atlas, e);
    if (s.tools.curve.over >= 0) return curve_.wheel(e, now_);
    if (s.tools.active == Tool::writing && !s.tools.writing.empty() && !(e.modifiers & (kAlt | kControl)))
        return writing_.wheel(e);
    if (s.tools.active == Tool::text && !s.tools.lettering.empty() && !(e.modifiers & (kAlt | kControl)))
        return lettering_.wheel(e);
    if ((e.modifiers & kAlt) && brush_can_be_turned(s.brush)) return roll_holder(s.tools.pointer, e.steps);
    last_turn_ = now_;
    Orbit& orbit = s.view.orbit;
    if (e.modifiers & kControl) {
        orbit.roll += 0.06 * e.steps;
        return;
    }
    const auto hit = aim_at(s.paint_thread->surface(), aim_of(s, e));
    orbit.zoom(e.steps, hit ? hit->position : orbit.target);
}

// The view may turn while the hand paints: the stroke goes on under the cursor, as on a banding wheel.
void StudioInput::fly(const Event& e) {
    Session& s = session_;
    s.preferences.space_mouse.seen = true;
    if (!s.paint_thread || is_dialog_open(s)) return;
    const double speed =
        s.preferences.space_mouse.moves_eye ? -s.preferences.space_mouse.speed : s.preferences.space_mouse.speed;
    s.view.orbit.fly(speed * e.push, speed * e.twist, s.preferences.space_mouse.level);
    last_turn_ = now_;
    Event at = cursor_;
    at.time = e.time;
    stroke_.follow_view(at);
}

void StudioInput::press(const Event& e) {
    Session& s = session_;
    const bool over_palette = in_palette(s.colours.palette, e);
    if (!ImGui::GetIO().WantCaptureMouse || over_palette) {
        bring_in_colour(s.colours, s.brush.ink, s.paint_thread.get());
        remember_brush(s.brush, s.paint_thread.get());
    }
    if (!s.paint_thread || is_dialog_open(s) || stroke_.drawing()) return;
    if (over_palette) return stroke_.press_palette(e);
    if (ImGui::GetIO().WantCaptureMouse || s.tools.curve.grabbed >= 0) return;
    if (!press_view(e) && e.button == 0 && comparison_.on_work(e) && !arm_.press(e) && !s.arm.in_stroke())
        press_tool(e);
}

// Begins to turn or move what is seen; false where the press is none for that.
bool StudioInput::press_view(const Event& e) {
    Session& s = session_;
    if (in_atlas(s.view.atlas, e)) {
        if (e.button == 0)
            look_at_uv(s, uv_at(s.view.atlas, e.x, e.y));
        else
            drag_ = Drag::atlas;
        return true;
    }
    const bool shift = e.modifiers & kShift, control = e.modifiers & kControl, alt = e.modifiers & kAlt;
    if (s.preferences.keymap == Keymap::maya && alt)
        drag_ = e.button == 0 ? Drag::turn : e.button == 2 ? Drag::pan : Drag::zoom;
    else if ((e.button == 0 && alt) || (e.button != 0 && s.preferences.keymap == Keymap::blender))
        drag_ = shift ? Drag::pan : control ? Drag::zoom : Drag::turn;
    return drag_ != Drag::none;
}

void StudioInput::press_tool(const Event& e) {
    Session& s = session_;
    if (press_move(s, e)) return;
    const Tool tool = s.tools.active;
    // Ink is shown as it is while one paints.
    if (tool != Tool::mask && tool != Tool::pick) select_entries(s.journal, s.paint_thread.get(), {});
    if (tool == Tool::writing) return writing_.place(cursor());
    if (tool == Tool::text) return lettering_.place(cursor());
    if (tool == Tool::pick) return press_pick(s, e);
    if (tool == Tool::mask) return press_mask(s, e);
    if (tool == Tool::fill) return press_fill(s, e);
    s.brush.erases = tool == Tool::eraser || e.eraser;
    if (tool == Tool::line || tool == Tool::curve) return curve_.press(e);
    stroke_.press(e);
}

void StudioInput::move(const Event& e) {
    Session& s = session_;
    if (stroke_.drawing()) return stroke_.move(e);
    if (drag_ == Drag::none && !ImGui::GetIO().WantCaptureMouse) arm_.move(e);
    if (s.tools.curve.grabbed >= 0) return curve_.drag(e);
    if (!s.masks.lasso.empty()) return move_lasso(s, e);
    if (s.journal.from) return drag_move(s, e);
    const double dx = kTurnPixels * (e.x - cursor_.x), dy = kTurnPixels * (e.y - cursor_.y);
    if (drag_ == Drag::atlas) {
        const double side = s.view.atlas.zoom * std::min(s.view.atlas.area.width, s.view.atlas.area.height);
        s.view.atlas.centre += Vec2(-(e.x - cursor_.x), e.y - cursor_.y) / side;
    }
    if (drag_ == Drag::turn)
        s.view.orbit.turn(dx, dy);
    else if (drag_ == Drag::pan)
        s.view.orbit.pan(dx, dy, std::min(s.view.area.width, s.view.area.height));
    else if (drag_ == Drag::zoom)
        s.view.orbit.zoom(0.03 * (dx - dy), s.view.orbit.target);
}

void StudioInput::release(const Event& e) {
    Session& s = session_;
    if (e.button == 0) {
        arm_.release(e);
        if (stroke_.drawing()) stroke_.release(e);
        if (!s.masks.lasso.empty()) release_lasso(s);
        if (s.journal.from) release_move(s, e);
        if (s.tools.curve.grabbed >= 0) curve_.release(e, now_);
    }
    drag_ = Drag::none;
}

void StudioInput::key(const Event& e) {
    Session& s = session_;
    const bool escape = e.key == GLFW_KEY_ESCAPE;
    if (ImGui::GetIO().WantTextInput && !escape) return;
    const auto action = s.preferences.keys.find({e.key, e.modifiers & (kShift | kControl | kAlt)});
    // Before all else: a hand may be in danger.
    if (s.arm.arm && action == Action::stop_arm && !ImGui::GetIO().WantTextInput) return stop_forces(s.arm);
    if (escape && stroke_.drawing()) return stroke_.cancel();
    if (escape && arm_.cancel()) return;
    if (stroke_.drawing() || s.arm.in_stroke()) return;
    // A menu or a list that is open lies over all else.
    if (escape && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return ImGui::ClosePopupToLevel(0, true);
    if (escape && !s.masks.lasso.empty()) return s.masks.lasso.clear();
    if (escape && close_top_dialog(s)) return;
    if (ImGui::GetIO().WantTextInput) return;
    if ((e.key == GLFW_KEY_ENTER || e.key == GLFW_KEY_KP_ENTER) && !s.dialogs.key_to_assign && is_dialog_open(s)) {
        s.ui.enter = true;
        return;
    }
    if (s.dialogs.key_to_assign) return assign_key(e);
    if (s.paint_thread && !is_dialog_open(s) && curve_.key(e, now_)) return;
    if (escape && close_top_panel(s)) return;
    if (s.paint_thread && !is_dialog_open(s) && e.key == GLFW_KEY_F2) {
        s.layers.list.renamed = s.layers.active;
        s.layers.list.focus = true;
        return;
    }
    if (action) perform(*action);
}

void StudioInput::assign_key(const Event& e) {
    Session& s = session_;
    const bool modifier = e.key >= GLFW_KEY_LEFT_SHIFT && e.key <= GLFW_KEY_RIGHT_SUPER;
    if (modifier || name_of(Chord{e.key, e.modifiers}).empty()) return;
    if (const auto other = s.preferences.keys.assign(*s.dialogs.key_to_assign, {e.key, e.modifiers}))
        show_message(s.status, Message("{} has no key now.", title_of(*other)));
    s.dialogs.key_to_assign.reset();
    store_settings(s);
}

void StudioInput::perform(Action action) {
    Session& s = session_;
    if (action == Action::open) return s.dialogs.file.show(FileDialog::Purpose::open, {});
    if (action == Action::quit) request_close(s, {});
    if (action == Action::keys) s.dialogs.show_keys = !s.dialogs.show_keys;
    if (!s.paint_thread || is_dialog_open(s) || perform_view(action) || perform_tool(action)) return;
    switch (action) {
        case Action::undo:
            s.paint_thread->post(UndoStroke{});
            break;
        case Action::redo:
            s.paint_thread->post(RedoStroke{});
            break;
        case Action::delete_stroke:
            if (!s.journal.selected.empty())
                s.paint_thread->post(
                    EditStrokes{.ids = {s.journal.selected.begin(), s.journal.selected.end()}, .remove = true});
            break;
        case Action::save:
            s.dialogs.file.show(FileDialog::Purpose::save,
                                project_name(s.paint_thread.get(), s.reported.file.project) + ".tuft");
            break;
        case Action::export_to:
            s.dialogs.show_export = true;
            break;
        case Action::palette:
            show_palette(s.colours.palette, s.brush, s.status, !s.colours.palette.shown);
            break;
        case Action::panels:
            fold_panels(s);
            break;
        case Action::arm:
            s.arm.shown = !s.arm.shown;
            break;
        default:
            break;
    }
}

// What changes how the model is seen; false for other acts.
bool StudioInput::perform_view(Action action) {
    static constexpr std::pair<Action, StandardView> kViews[] = {
        {Action::front, StandardView::front}, {Action::back, StandardView::back},
        {Action::right, StandardView::right}, {Action::left, StandardView::left},
        {Action::top, StandardView::top},     {Action::bottom, StandardView::bottom}};
    Session& s = session_;
    ViewState& view = s.view;
    for (const auto& [key, standard] : kViews)
        if (action == key) return view.orbit.look_from(standard), true;
    if (action == Action::frame_all)
        view.orbit.frame(s.paint_thread->model().mesh->bounds);
    else if (action == Action::frame_cursor) {
        if (const auto hit = aim_at(s.paint_thread->surface(), aim_of(s, cursor_))) view.orbit.target = hit->position;
    } else if (action == Action::parallel)
        view.orbit.set_parallel(!view.orbit.parallel);
    else if (action == Action::atlas)
        view.atlas.shown = !view.atlas.shown;
    else if (action == Action::see_through)
        view.see_through = !view.see_through;
    else if (action == Action::next_shading)
        view.shading = static_cast<ModelView>((static_cast<int>(view.shading) + 1) % kModelViews);
    else
        return false;
    return true;
}

// What chooses a tool or sets the brush; false for other acts.
bool StudioInput::perform_tool(Action action) {
    static constexpr std::pair<Action, Tool> kTools[] = {
        {Action::brush, Tool::brush},     {Action::line, Tool::line}, {Action::curve, Tool::curve},
        {Action::writing, Tool::writing}, {Action::text, Tool::text}, {Action::eraser, Tool::eraser},
        {Action::fill, Tool::fill},       {Action::pick, Tool::pick}, {Action::mask, Tool::mask}};
    static constexpr std::tuple<Action, double, double> kLeans[] = {
        {Action::lean_left, -1, 0}, {Action::lean_right, 1, 0}, {Action::lean_away, 0, 1}, {Action::lean_near, 0, -1}};
    Session& s = session_;
    PointerSettings& pointer = s.tools.pointer;
    for (const auto& [key, tool] : kTools)
        if (action == key) return s.tools.active = tool, true;
    for (const auto& [key, x, y] : kLeans)
        if (action == key)
            return pointer.tilt = glm::clamp(pointer.tilt + Vec2(x, y) * 0.0872664626, -1.0471975512, 1.0471975512),
                   true;
    if (action == Action::roll_anticlockwise || action == Action::roll_clockwise)
        return roll_holder(pointer, action == Action::roll_anticlockwise ? 1 : -1), true;
    const double factor = brush::sized_name(s.brush.preset).factor;
    if (action == Action::upright)
        pointer.tilt = Vec2(0);
    else if (action == Action::lighter)
        pointer.pressure = std::max(0.02, pointer.pressure - 0.05);
    else if (action == Action::heavier)
        pointer.pressure = std::min(1.0, pointer.pressure + 0.05);
    else if (action == Action::smaller)
        size_brush(s.brush, s.status, factor / 1.1);
    else if (action == Action::larger)
        size_brush(s.brush, s.status, factor * 1.1);
    else
        return false;
    return true;
}

}  // namespace tuft::app
