#include "app/tools/arm_input.h"

#include <utility>

#include "app/session/top_dialog.h"
#include "app/tools/aim.h"
#include "app/tools/stroke_input.h"
#include "brush/preset/preset.h"

namespace tuft::app {
namespace {

constexpr double kRegrip = 0.1;       // s without force while the space changes, so that nothing jumps
constexpr std::uint32_t kClutch = 1;  // first button of the grip
constexpr double kHover = 4e-3;       // m of the tip over the surface, of a hand that follows the pointer
constexpr double kPressed = 0.5;      // of the tuft's length at full pressure
constexpr double kCounted = 0.5;      // s over which the loop's rate is counted
constexpr double kBetweenStarts = 5;  // pixels between two looks for the model round the middle of the view

}  // namespace

// From the arm's axes, x right, y away, z up.
Quat ArmInput::axes() const {
    const Session& s = session_;
    if (!s.arm.settings.with_view || s.arm.on_palette) return {1, 0, 0, 0};
    const render::GlCamera c = camera_of(s);
    return glm::normalize(glm::quat_cast(glm::dmat3(c.right, c.forward, c.up)));
}

// What the middle of the view shows, or what is nearest to it.
std::optional<Frame> ArmInput::start_frame() const {
    const Session& s = session_;
    if (s.arm.on_palette) return make_frame(Vec3{0}, Vec3{0, 0, 1}, Vec3{1, 0, 0});
    const Area& area = s.view.area;
    const double x = area.x + 0.5 * area.width, y = area.y + 0.5 * area.height;
    for (double reach = 0; reach < 0.5 * area.height; reach += kBetweenStarts)
        for (const Vec2& side : {Vec2{0, 1}, Vec2{0, -1}, Vec2{1, 0}, Vec2{-1, 0}}) {
            const Aim aim = aim_of(s, {.x = x + reach * side.x, .y = y + reach * side.y});
            if (const auto hit = aim_at(s.paint_thread->surface(), aim))
                return make_frame(hit->position,
                                  glm::dot(hit->normal, aim.ray.direction) > 0 ? -hit->normal : hit->normal,
                                  Vec3{1, 0, 0});
        }
    return std::nullopt;
}

// The loop begins anew for another model, brush or place; a stroke in work is ended first by the hand.
void ArmInput::follow_scene() {
    Session& s = session_;
    ArmState& a = s.arm;
    a.on_palette = a.on_palette && s.colours.palette.shown;
    const bool same = a.arm->feels() && work_ == s.paint_thread.get() && surface_ == s.paint_thread->shared_surface() &&
                      brush_ == s.brush.preset && on_palette_ == a.on_palette;
    if (same || a.in_stroke() || !a.arm->ready()) return;
    const std::optional<Frame> start = start_frame();
    if (!start) return;
    if (a.on_palette && !plate_) plate_ = stroke::make_palette();
    try {
        preset_ = brush::load_preset(s.brush.preset);
        // The loop stops with the former surface before that goes.
        std::shared_ptr<const mesh::SurfaceQuery> surface = s.paint_thread->shared_surface();
        a.arm->feel({.surface = a.on_palette ? plate_->query.get() : surface.get(),
                     .brush = preset_,
                     .start = *start,
                     .axes = axes()});
        surface_ = std::move(surface);
    } catch (const Error& error) {
        show_message(s.status, error.message());
        return a.arm.reset();
    }
    work_ = s.paint_thread.get();
    brush_ = s.brush.preset;
    on_palette_ = a.on_palette;
    with_view_ = a.settings.with_view;
    scale_ = a.settings.scale;
}

void ArmInput::control(double now) {
    Session& s = session_;
    ArmState& a = s.arm;
    if (with_view_ != a.settings.with_view || scale_ != a.settings.scale || a.regrips_until == kRegripsSoon)
        a.regrips_until = now + kRegrip;
    with_view_ = a.settings.with_view;
    scale_ = a.settings.scale;
    const bool regrips = now < a.regrips_until;
    // First the force goes, then the space changes.
    if (now >= a.regrips_until - 0.5 * kRegrip) {
        a.arm->apply(a.settings);
        a.arm->set_workspace(s.view.orbit.target, axes(), a.settings.with_view && !a.on_palette);
    }
    a.arm->set_control({.paused = a.paused || !a.focused || is_dialog_open(s),
                        .emergency = a.emergency,
                        .clutched = a.clutched || regrips,
                        .clutch_buttons = kClutch});
    const ink::Ink* ink = s.brush.erases ? nullptr : find_ink(s.colours, s.brush.ink);
    a.arm->set_ink(s.reported.brush.wetness, s.reported.brush.fullness, ink ? ink->yield : 0);
}

// A fault is said once, in one line.
void ArmInput::report() {
    Session& s = session_;
    ArmState& a = s.arm;
    const haptic::Fault fault = a.arm->status().fault;
    const bool person = fault == haptic::Fault::paused || fault == haptic::Fault::none;
    if (fault != a.reported && !person) show_message(s.status, haptic::describe(fault));
    a.reported = fault;
    const Message trouble = a.arm->trouble();
    if (!trouble.empty() && !a.lost) show_message(s.status, trouble);
    a.lost = !trouble.empty();
}

void ArmInput::update(double now, bool pointer_draws) {
    Session& s = session_;
    ArmState& a = s.arm;
    if (!a.arm) return;
    if (!s.paint_thread || s.view.model_changed) {
        work_ = nullptr;
        return;
    }
    follow_scene();
    if (!a.arm || !a.arm->feels()) return;
    control(now);
    const bool tool = s.tools.active == Tool::brush || s.tools.active == Tool::eraser;
    a.paints = tool && !pointer_draws && !s.reported.file.viewing && !s.journal.move_on_drag;
    if (!a.in_stroke() && !pointer_draws) {
        s.brush.erases = s.tools.active == Tool::eraser && !on_palette_;
        a.begin = on_palette_ ? stroke_to_stir(s) : stroke_to_begin(s);
    }
    post_arm_strokes(a, *s.paint_thread);
    const std::uint64_t periods = a.arm->poll().counts.periods;
    if (periods < counted_periods_ || now - counted_at_ > kCounted) {
        if (periods > counted_periods_) a.rate = static_cast<double>(periods - counted_periods_) / (now - counted_at_);
        counted_periods_ = periods;
        counted_at_ = now;
    }
    report();
    if (!a.arm->open() && !a.in_stroke()) {
        disconnect_arm(a, s.paint_thread.get());
        show_message(s.status, "The recording has ended.");
    }
}

bool ArmInput::press(const Event& e) {
    Session& s = session_;
    const bool tool = s.tools.active == Tool::brush || s.tools.active == Tool::eraser;
    if (!s.arm.arm || !s.arm.arm->follows_pointer() || !tool) return false;
    pressed_ = true;
    move(e);
    return true;
}

// The root over the surface under the pointer, as a hand holds a pen: pressed as deep as a pen would press.
void ArmInput::move(const Event& e) {
    Session& s = session_;
    ArmState& a = s.arm;
    if (!a.arm || !a.arm->follows_pointer() || !a.arm->feels() || a.clutched || on_palette_) return;
    const Aim aim = aim_of(s, e);
    const PointerInput hand(s.paint_thread->surface(), preset_, s.tools.pointer);
    const auto pose = hand.hover(aim);
    const auto surface = hand.find_surface(aim);
    if (!pose || !surface || surface->inside) return;
    const double length = preset_.length;
    const double pressure = e.pressure >= 0 ? e.pressure : s.tools.pointer.pressure;
    const double up = pressed_ ? -kPressed * pressure * length : kHover;
    a.arm->point_to(surface->position - (length + up) * pose->axis(), pose->rotation);
}

void ArmInput::release(const Event& e) {
    if (!std::exchange(pressed_, false)) return;
    move(e);
}

bool ArmInput::cancel() {
    if (!session_.arm.in_stroke()) return false;
    session_.arm.arm->drop_stroke();
    session_.paint_thread->post(CancelStroke{});
    return true;
}

std::optional<brush::Pose> ArmInput::hover() const {
    const ArmState& a = session_.arm;
    if (!a.arm || !a.arm->feels() || on_palette_ || a.arm->status().counts.periods == 0) return std::nullopt;
    const haptic::LoopStatus& now = a.arm->status();
    return brush::Pose{now.engaged ? now.root : now.arm, now.rotation, 0};
}

}  // namespace tuft::app
