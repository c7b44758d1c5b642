#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels.h"
#include "app/studio.h"

/// What the window does with a person's events: painting, looking round, keys.
namespace tuft::app {
namespace {

constexpr double kTurnPixels = 1.0;

}  // namespace

Aim Studio::aim_of(const Event& e) const {
    const render::GlCamera c = camera();
    Aim aim{.ray = render::ray_at(c, e.x - session_.area.x, e.y - session_.area.y),
            .view_right = c.right,
            .view_up = c.up,
            .metres_per_pixel = render::metres_per_pixel(c, session_.view.orbit.target),
            .time = e.time,
            .pressure = e.pressure,
            .section = section_plane(session_)};
    if (e.pressure >= 0) aim.tilt = Vec2(e.tilt.x, -e.tilt.y);
    return aim;
}

void Studio::post(std::vector<HandStep> steps, double time) {
    Session& s = session_;
    for (HandStep& step : steps) {
        if (step.kind == HandStep::Kind::begin) s.painter->post(BeginStroke{s.brush, s.ink, s.symmetry, s.carry});
        else if (step.kind == HandStep::Kind::end) s.painter->post(EndStroke{});
        else s.painter->post(ExtendStroke{std::move(step.poses), time});
    }
}

void Studio::handle(const Event& e) {
    Session& s = session_;
    switch (e.kind) {
        case Event::Kind::drop: open_path(s, e.text); return;
        case Event::Kind::key_down: key(e); return;
        case Event::Kind::press: press(e); break;
        case Event::Kind::move: move(e); break;
        case Event::Kind::release: release(e); break;
        case Event::Kind::hover_end: cursor_inside_ = false; return;
        case Event::Kind::scroll:
            if (!s.painter || ImGui::GetIO().WantCaptureMouse) return;
            if (in_atlas(e)) return atlas_wheel(e);
            if (s.curve.over >= 0) return curve_wheel(e);
            if (s.tool == Tool::writing && !s.writing.empty() && !(e.modifiers & (kAlt | kControl))) return writing_wheel(e);
            last_turn_ = now_;
            if (e.modifiers & kControl) s.view.orbit.roll += 0.06 * e.steps;
            else {
                const auto hit = aim_at(*s.painter->model().query, aim_of(e));
                s.view.orbit.zoom(e.steps, hit ? hit->position : s.view.orbit.target);
            }
            return;
        default: return;
    }
    cursor_ = e;
    cursor_inside_ = !ImGui::GetIO().WantCaptureMouse && e.x >= s.area.x && e.y >= s.area.y && e.x < s.area.x + s.area.width &&
                     e.y < s.area.y + s.area.height;
}

void Studio::press(const Event& e) {
    Session& s = session_;
    if (!s.painter || ImGui::GetIO().WantCaptureMouse || dialog_open() || hand_ || s.curve.grabbed >= 0) return;
    if (in_atlas(e)) return atlas_press(e);
    const bool shift = e.modifiers & kShift, control = e.modifiers & kControl, alt = e.modifiers & kAlt;
    if (s.keymap == Keymap::maya && alt)
        drag_ = e.button == 0 ? Drag::turn : e.button == 2 ? Drag::pan : Drag::zoom;
    else if (e.button == 0 && alt) drag_ = shift ? Drag::pan : control ? Drag::zoom : Drag::turn;
    else if (e.button != 0 && s.keymap == Keymap::blender) drag_ = shift ? Drag::pan : control ? Drag::zoom : Drag::turn;
    if (drag_ != Drag::none || e.button != 0) return;
    if (shift_press(e)) return;
    if (s.tool == Tool::writing) return lay_writing();
    if (s.tool == Tool::line || s.tool == Tool::curve) return curve_press(e);
    try {
        hand_.emplace(*s.painter->model().query, brush::load_preset(s.brush), s.hand);
    } catch (const Error& error) {
        say(s, error.what());
        return;
    }
    s.hand_down = true;
    post(hand_->move(aim_of(e)), e.time);
}

void Studio::move(const Event& e) {
    Session& s = session_;
    if (hand_) {
        post(hand_->move(aim_of(e)), e.time);
        return;
    }
    if (s.curve.grabbed >= 0) return curve_drag(e);
    if (s.shift_from) {
        if (const auto to = aim_at(*s.painter->model().query, aim_of(e))) s.shift_to = to;
        return;
    }
    const double dx = kTurnPixels * (e.x - cursor_.x), dy = kTurnPixels * (e.y - cursor_.y);
    if (drag_ == Drag::atlas) {
        const double side = s.view.atlas_zoom * std::min(s.atlas_area.width, s.atlas_area.height);
        s.view.atlas_centre += Vec2(-(e.x - cursor_.x), e.y - cursor_.y) / side;
    }
    if (drag_ == Drag::turn) s.view.orbit.turn(dx, dy);
    else if (drag_ == Drag::pan) s.view.orbit.pan(dx, dy, std::min(s.area.width, s.area.height));
    else if (drag_ == Drag::zoom) s.view.orbit.zoom(0.03 * (dx - dy), s.view.orbit.target);
}

void Studio::release(const Event& e) {
    Session& s = session_;
    if (hand_ && e.button == 0) {
        post(hand_->move(aim_of(e)), e.time);
        post(hand_->lift(), e.time);
        hand_.reset();
        s.hand_down = false;
    }
    if (e.button == 0 && s.shift_from) shift_release(e);
    if (e.button == 0 && s.curve.grabbed >= 0) curve_release(e);
    drag_ = Drag::none;
}

void Studio::key(const Event& e) {
    Session& s = session_;
    if (ImGui::GetIO().WantTextInput && e.key != GLFW_KEY_ESCAPE) return;
    const bool shift = e.modifiers & kShift, control = e.modifiers & kControl;
    if (e.key == GLFW_KEY_ESCAPE && hand_) {
        hand_.reset();
        s.hand_down = false;
        s.painter->post(CancelStroke{});
        return;
    }
    if (hand_) return;
    if (e.key == GLFW_KEY_ESCAPE && close_dialog(s)) return;
    if (control && e.key == GLFW_KEY_O) return s.files.show(FileDialog::Purpose::open, {});
    if (control && e.key == GLFW_KEY_Q) s.quit = true;
    if (e.key == GLFW_KEY_F1) s.show_keys = !s.show_keys;
    if (!s.painter || dialog_open()) return;
    if (curve_key(e)) return;
    const auto tilt = [&](double x, double y) {
        s.hand.tilt = glm::clamp(s.hand.tilt + Vec2(x, y) * 0.0872664626, -1.0471975512, 1.0471975512);
    };
    Orbit& o = s.view.orbit;
    switch (e.key) {
        case GLFW_KEY_Z:
            if (control) s.painter->post(shift ? Command(RedoStroke{}) : Command(UndoStroke{}));
            break;
        case GLFW_KEY_Y:
            if (control) s.painter->post(RedoStroke{});
            break;
        case GLFW_KEY_S:
            if (control) s.files.show(FileDialog::Purpose::save, project_name(s) + ".tuft");
            break;
        case GLFW_KEY_E:
            if (control) s.show_export = true;
            break;
        case GLFW_KEY_HOME: o.frame(s.painter->model().mesh->bounds); break;
        case GLFW_KEY_PERIOD:
        case GLFW_KEY_KP_DECIMAL:
            if (const auto hit = aim_at(*s.painter->model().query, aim_of(cursor_))) o.target = hit->position;
            break;
        case GLFW_KEY_1:
        case GLFW_KEY_KP_1: o.look_from(control ? StandardView::back : StandardView::front); break;
        case GLFW_KEY_3:
        case GLFW_KEY_KP_3: o.look_from(control ? StandardView::left : StandardView::right); break;
        case GLFW_KEY_7:
        case GLFW_KEY_KP_7: o.look_from(control ? StandardView::bottom : StandardView::top); break;
        case GLFW_KEY_5:
        case GLFW_KEY_KP_5: o.parallel = !o.parallel; break;
        case GLFW_KEY_LEFT_BRACKET: s.hand.pressure = std::max(0.02, s.hand.pressure - 0.05); break;
        case GLFW_KEY_RIGHT_BRACKET: s.hand.pressure = std::min(1.0, s.hand.pressure + 0.05); break;
        case GLFW_KEY_LEFT: tilt(-1, 0); break;
        case GLFW_KEY_RIGHT: tilt(1, 0); break;
        case GLFW_KEY_UP: tilt(0, 1); break;
        case GLFW_KEY_DOWN: tilt(0, -1); break;
        case GLFW_KEY_BACKSLASH: s.hand.tilt = Vec2(0); break;
        case GLFW_KEY_B: s.tool = Tool::brush; break;
        case GLFW_KEY_L: s.tool = Tool::line; break;
        case GLFW_KEY_C: s.tool = Tool::curve; break;
        case GLFW_KEY_T: s.tool = Tool::writing; break;
        case GLFW_KEY_U: s.view.atlas = !s.view.atlas; break;
        case GLFW_KEY_X: s.view.see_through = !s.view.see_through; break;
        default: break;
    }
}

}  // namespace tuft::app
