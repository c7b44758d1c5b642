#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/session/top_dialog.h"
#include "app/studio/studio.h"

/// What the window does with a person's events: painting, looking round, keys.
namespace tuft::app {
namespace {

constexpr double kTurnPixels = 1.0;

}  // namespace

Aim Studio::aim_of(const Event& e) const {
    const render::GlCamera c = camera();
    Aim aim{.ray = render::ray_at(c, e.x - session_.view.area.x, e.y - session_.view.area.y),
            .view_right = c.right,
            .view_up = c.up,
            .metres_per_pixel = render::metres_per_pixel(c, session_.view.orbit.target),
            .time = e.time,
            .pressure = e.pressure,
            .section = section_plane(session_.view, session_.paint_thread->model().mesh->bounds)};
    if (e.pressure >= 0) {
        aim.tilt = Vec2(e.tilt.x, -e.tilt.y);
        aim.turn = e.turn;
    }
    return aim;
}

// What a stroke is painted with, by hand or along a line.
BeginStroke Studio::stroke_to_begin() const {
    const Session& s = session_;
    return {.brush = s.brush.preset,
            .ink = s.brush.ink,
            .symmetry = s.tools.symmetry,
            .carry = s.brush.persistent,
            .as_it_is = s.brush.persistent && s.colours.palette.shown,
            .layer = s.layers.active,
            .mask = s.masks.active,
            .erases = s.brush.erases,
            .wet = s.brush.wet,
            .tip_ink = s.brush.two_inks ? s.brush.tip_ink : "",
            .tip_depth = s.brush.tip_depth};
}

void Studio::post(std::vector<HandStep> steps, double time) {
    Session& s = session_;
    for (HandStep& step : steps) {
        if (step.kind == HandStep::Kind::begin && on_plate_)
            s.paint_thread->post(BeginStroke{.brush = s.brush.preset,
                                             .ink = s.brush.ink,
                                             .carry = true,
                                             .as_it_is = true,
                                             .layer = stroke::kPaletteLayer,
                                             .wet = true});
        else if (step.kind == HandStep::Kind::begin)
            s.paint_thread->post(stroke_to_begin());
        else if (step.kind == HandStep::Kind::end)
            s.paint_thread->post(EndStroke{});
        else {
            ++samples_;
            asked_.push_back(time);
            s.paint_thread->post(ExtendStroke{std::move(step.poses), time});
        }
    }
}

void Studio::handle(const Event& e) {
    Session& s = session_;
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
            if (s.paint_thread && !is_dialog_open(session_))
                perform(e.button == 0 ? Act::frame_all : Act::frame_cursor);
            return;
        case Event::Kind::hover_end:
            cursor_inside_ = false;
            return;
        case Event::Kind::scroll:
            if (!s.paint_thread || ImGui::GetIO().WantCaptureMouse) return;
            if (in_atlas(e)) return atlas_wheel(e);
            if (s.tools.curve.over >= 0) return curve_wheel(e);
            if (s.tools.active == Tool::writing && !s.tools.writing.empty() && !(e.modifiers & (kAlt | kControl)))
                return writing_wheel(e);
            last_turn_ = now_;
            if (e.modifiers & kControl)
                s.view.orbit.roll += 0.06 * e.steps;
            else {
                const auto hit = aim_at(*s.paint_thread->model().query, aim_of(e));
                s.view.orbit.zoom(e.steps, hit ? hit->position : s.view.orbit.target);
            }
            return;
        default:
            return;
    }
    if (e.pressure >= 0) s.tools.pen_pressure = e.pressure;
    cursor_ = e;
    cursor_inside_ = !ImGui::GetIO().WantCaptureMouse && e.x >= s.view.area.x && e.y >= s.view.area.y &&
                     e.x < s.view.area.x + s.view.area.width && e.y < s.view.area.y + s.view.area.height;
}

// The view may turn while the hand paints: the stroke goes on under the cursor, as on a banding wheel.
void Studio::fly(const Event& e) {
    Session& s = session_;
    s.preferences.space_mouse.seen = true;
    if (!s.paint_thread || is_dialog_open(session_)) return;
    const double way =
        s.preferences.space_mouse.moves_eye ? -s.preferences.space_mouse.speed : s.preferences.space_mouse.speed;
    s.view.orbit.fly(way * e.push, way * e.twist, s.preferences.space_mouse.level);
    last_turn_ = now_;
    if (!hand_ || on_plate_) return;
    Event at = cursor_;
    at.time = e.time;
    post(hand_->move(aim_of(at)), e.time);
}

void Studio::press(const Event& e) {
    Session& s = session_;
    if (!ImGui::GetIO().WantCaptureMouse || in_palette(e)) {
        bring_in_colour(s.colours, s.brush.ink, s.paint_thread.get());
        remember_brush(s.brush, s.paint_thread.get());
    }
    if (s.paint_thread && !is_dialog_open(session_) && !hand_ && in_palette(e)) return palette_press(e);
    if (!s.paint_thread || ImGui::GetIO().WantCaptureMouse || is_dialog_open(session_) || hand_ ||
        s.tools.curve.grabbed >= 0)
        return;
    if (in_atlas(e)) return atlas_press(e);
    const bool shift = e.modifiers & kShift, control = e.modifiers & kControl, alt = e.modifiers & kAlt;
    if (s.preferences.keymap == Keymap::maya && alt)
        drag_ = e.button == 0 ? Drag::turn : e.button == 2 ? Drag::pan : Drag::zoom;
    else if (e.button == 0 && alt)
        drag_ = shift ? Drag::pan : control ? Drag::zoom : Drag::turn;
    else if (e.button != 0 && s.preferences.keymap == Keymap::blender)
        drag_ = shift ? Drag::pan : control ? Drag::zoom : Drag::turn;
    if (drag_ != Drag::none || e.button != 0 || !on_work(e)) return;
    if (shift_press(e)) return;
    if (s.tools.active != Tool::mask && s.tools.active != Tool::pick)
        select_entries(s.journal, s.paint_thread.get(), {});  // ink is shown as it is while one paints
    if (s.tools.active == Tool::writing) return lay_writing();
    if (s.tools.active == Tool::pick) return pick_press(e);
    if (s.tools.active == Tool::mask) return mask_press(e);
    if (s.tools.active == Tool::fill) {
        const auto hit = aim_at(*s.paint_thread->model().query, aim_of(e));
        if (!hit) return;
        s.tools.fill.at = hit->position;
        s.paint_thread->post(FillModel{s.brush.ink, s.tools.fill, s.layers.active, s.masks.active});
        return;
    }
    s.brush.erases = s.tools.active == Tool::eraser || e.eraser;
    if (s.tools.active == Tool::line || s.tools.active == Tool::curve) return curve_press(e);
    try {
        const brush::Preset preset = brush::load_preset(s.brush.preset);
        hand_.emplace(*s.paint_thread->model().query, preset, s.tools.pointer, tip_lag(preset));
    } catch (const Error& error) {
        show_message(s.status, error.what());
        return;
    }
    s.tools.pointer_down = true;
    on_plate_ = false;
    post(hand_->move(aim_of(e)), e.time);
}

void Studio::move(const Event& e) {
    Session& s = session_;
    if (hand_) {
        post(hand_->move(on_plate_ ? palette_aim(e) : aim_of(e)), e.time);
        return;
    }
    if (s.tools.curve.grabbed >= 0) return curve_drag(e);
    if (!s.masks.lasso.empty()) return lasso_move(e);
    if (s.journal.from) {
        if (const auto to = aim_at(*s.paint_thread->model().query, aim_of(e))) s.journal.to = to;
        return;
    }
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

void Studio::release(const Event& e) {
    Session& s = session_;
    if (hand_ && e.button == 0) {
        post(hand_->move(on_plate_ ? palette_aim(e) : aim_of(e)), e.time);
        post(hand_->lift(), e.time);
        hand_.reset();
        s.tools.pointer_down = false;
    }
    if (e.button == 0 && !s.masks.lasso.empty()) lasso_release();
    if (e.button == 0 && s.journal.from) shift_release(e);
    if (e.button == 0 && s.tools.curve.grabbed >= 0) curve_release(e);
    drag_ = Drag::none;
}

void Studio::key(const Event& e) {
    Session& s = session_;
    if (ImGui::GetIO().WantTextInput && e.key != GLFW_KEY_ESCAPE) return;
    if (e.key == GLFW_KEY_ESCAPE && hand_) {
        hand_.reset();
        s.tools.pointer_down = false;
        s.paint_thread->post(CancelStroke{});
        return;
    }
    if (hand_) return;
    if (e.key == GLFW_KEY_ESCAPE && !s.masks.lasso.empty()) return s.masks.lasso.clear();
    if (e.key == GLFW_KEY_ESCAPE && close_top_dialog(s)) return;
    if (ImGui::GetIO().WantTextInput) return;
    if ((e.key == GLFW_KEY_ENTER || e.key == GLFW_KEY_KP_ENTER) && !s.dialogs.key_to_assign &&
        is_dialog_open(session_)) {
        s.ui.enter = true;
        return;
    }
    if (s.dialogs.key_to_assign) {
        const bool modifier = e.key >= GLFW_KEY_LEFT_SHIFT && e.key <= GLFW_KEY_RIGHT_SUPER;
        if (modifier || name_of(Chord{e.key, e.modifiers}).empty()) return;
        if (const auto other = s.preferences.keys.assign(*s.dialogs.key_to_assign, {e.key, e.modifiers}))
            show_message(s.status, std::string(s.ui.tr(title_of(*other))) + s.ui.tr(" has no key now."));
        s.dialogs.key_to_assign.reset();
        store_settings(s);
        return;
    }
    if (s.paint_thread && !is_dialog_open(session_) && curve_key(e)) return;
    if (s.paint_thread && !is_dialog_open(session_) && e.key == GLFW_KEY_F2) {
        s.layers.list.renamed = s.layers.active;
        s.layers.list.focus = true;
        return;
    }
    if (const auto act = s.preferences.keys.find({e.key, e.modifiers & (kShift | kControl | kAlt)})) perform(*act);
}

void Studio::perform(Act act) {
    Session& s = session_;
    if (act == Act::open) return s.dialogs.file.show(FileDialog::Purpose::open, {});
    if (act == Act::quit) request_close(s, {});
    if (act == Act::keys) s.dialogs.show_keys = !s.dialogs.show_keys;
    if (!s.paint_thread || is_dialog_open(session_)) return;
    const auto tilt = [&](double x, double y) {
        s.tools.pointer.tilt =
            glm::clamp(s.tools.pointer.tilt + Vec2(x, y) * 0.0872664626, -1.0471975512, 1.0471975512);
    };
    Orbit& o = s.view.orbit;
    switch (act) {
        case Act::undo:
            s.paint_thread->post(UndoStroke{});
            break;
        case Act::redo:
            s.paint_thread->post(RedoStroke{});
            break;
        case Act::delete_stroke:
            if (!s.journal.selected.empty())
                s.paint_thread->post(
                    EditStrokes{.ids = {s.journal.selected.begin(), s.journal.selected.end()}, .remove = true});
            break;
        case Act::save:
            s.dialogs.file.show(FileDialog::Purpose::save,
                                project_name(s.paint_thread.get(), s.reported.file.project) + ".tuft");
            break;
        case Act::export_to:
            s.dialogs.show_export = true;
            break;
        case Act::frame_all:
            o.frame(s.paint_thread->model().mesh->bounds);
            break;
        case Act::frame_cursor:
            if (const auto hit = aim_at(*s.paint_thread->model().query, aim_of(cursor_))) o.target = hit->position;
            break;
        case Act::front:
            o.look_from(StandardView::front);
            break;
        case Act::back:
            o.look_from(StandardView::back);
            break;
        case Act::right:
            o.look_from(StandardView::right);
            break;
        case Act::left:
            o.look_from(StandardView::left);
            break;
        case Act::top:
            o.look_from(StandardView::top);
            break;
        case Act::bottom:
            o.look_from(StandardView::bottom);
            break;
        case Act::parallel:
            o.set_parallel(!o.parallel);
            break;
        case Act::lighter:
            s.tools.pointer.pressure = std::max(0.02, s.tools.pointer.pressure - 0.05);
            break;
        case Act::heavier:
            s.tools.pointer.pressure = std::min(1.0, s.tools.pointer.pressure + 0.05);
            break;
        case Act::smaller:
            size_brush(s.brush, s.status, brush::sized_name(s.brush.preset).factor / 1.1);
            break;
        case Act::larger:
            size_brush(s.brush, s.status, brush::sized_name(s.brush.preset).factor * 1.1);
            break;
        case Act::lean_left:
            tilt(-1, 0);
            break;
        case Act::lean_right:
            tilt(1, 0);
            break;
        case Act::lean_away:
            tilt(0, 1);
            break;
        case Act::lean_near:
            tilt(0, -1);
            break;
        case Act::upright:
            s.tools.pointer.tilt = Vec2(0);
            break;
        case Act::brush:
            s.tools.active = Tool::brush;
            break;
        case Act::line:
            s.tools.active = Tool::line;
            break;
        case Act::curve:
            s.tools.active = Tool::curve;
            break;
        case Act::writing:
            s.tools.active = Tool::writing;
            break;
        case Act::eraser:
            s.tools.active = Tool::eraser;
            break;
        case Act::fill:
            s.tools.active = Tool::fill;
            break;
        case Act::palette:
            show_palette(s.colours.palette, s.brush, s.status, !s.colours.palette.shown);
            break;
        case Act::pick:
            s.tools.active = Tool::pick;
            break;
        case Act::mask:
            s.tools.active = Tool::mask;
            break;
        case Act::atlas:
            s.view.atlas.shown = !s.view.atlas.shown;
            break;
        case Act::see_through:
            s.view.see_through = !s.view.see_through;
            break;
        case Act::next_shading:
            s.view.shading = static_cast<ModelView>((static_cast<int>(s.view.shading) + 1) % kModelViews);
            break;
        case Act::panels:
            fold_panels(s);
            break;
        default:
            break;
    }
}

}  // namespace tuft::app
