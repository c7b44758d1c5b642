#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/studio/studio.h"

/// Lines and curves: setting, moving and painting their control points.
namespace tuft::app {
namespace {

constexpr double kGrab = 11;     // pixels round a control point, at a scale of 1
constexpr double kShortest = 3;  // pixels of a line
constexpr double kSnap = std::numbers::pi / 12;

}  // namespace

// The control point under the cursor, -1: none.
int Studio::curve_point_at(const Event& e) const {
    const Session& s = session_;
    const render::GlCamera c = camera();
    int nearest = -1;
    double least = kGrab * static_cast<double>(s.ui.settings().scale);
    for (std::size_t i = 0; i < s.curve.points.size(); ++i) {
        const Vec3 at = render::picture_point(c, s.curve.points[i].position);
        const double away = std::hypot(at.x + s.area.x - e.x, at.y + s.area.y - e.y);
        if (away < least) least = away, nearest = static_cast<int>(i);
    }
    return nearest;
}

std::optional<CurvePoint> Studio::curve_point(const Event& e) const {
    const Aim aim = aim_of(e);
    const auto hit = aim_at(*session_.painter->model().query, aim);
    if (!hit) return std::nullopt;
    return CurvePoint{.position = hit->position, .outward = -aim.ray.direction};
}

bool Studio::curve_editable() const {
    const Session& s = session_;
    return s.curve.last_stroke != 0 && !s.strokes.empty() && s.strokes.back().id == s.curve.last_stroke;
}

void Studio::curve_press(const Event& e) {
    CurveInWork& curve = session_.curve;
    curve.grabbed = curve_point_at(e);
    if (curve.grabbed >= 0) return;
    const auto point = curve_point(e);
    if (!point) return;
    // A painted line or curve is done when a new one is begun.
    if (session_.tool == Tool::line || curve.last_stroke || curve.waits) curve = {};
    curve.points.push_back(*point);
    if (session_.tool == Tool::line) curve.points.push_back(*point);
    curve.grabbed = static_cast<int>(curve.points.size()) - 1;
    line_start_ = e;
}

void Studio::curve_drag(const Event& e) {
    CurveInWork& curve = session_.curve;
    if (curve.grabbed < 0) return;
    CurvePoint& grabbed = curve.points[static_cast<std::size_t>(curve.grabbed)];
    Event at = e;
    if ((e.modifiers & kShift) && curve.points.size() >= 2) {
        // Steps of 15° round the neighbour, as seen.
        const std::size_t other = curve.grabbed > 0 ? static_cast<std::size_t>(curve.grabbed) - 1 : 1;
        const Vec3 pivot = render::picture_point(camera(), curve.points[other].position);
        const double x = e.x - session_.area.x - pivot.x, y = e.y - session_.area.y - pivot.y;
        const double angle = kSnap * std::round(std::atan2(y, x) / kSnap),
                     length = x * std::cos(angle) + y * std::sin(angle);
        at.x = pivot.x + session_.area.x + length * std::cos(angle);
        at.y = pivot.y + session_.area.y + length * std::sin(angle);
    }
    if (auto point = curve_point(at)) {
        point->pressure = grabbed.pressure;
        grabbed = *point;
        curve.changed = true;
    }
}

void Studio::curve_release(const Event& e) {
    CurveInWork& curve = session_.curve;
    const bool fresh_line = session_.tool == Tool::line && line_start_ && !curve.last_stroke;
    const bool moved = line_start_ && std::hypot(e.x - line_start_->x, e.y - line_start_->y) >= kShortest;
    curve.grabbed = -1;
    line_start_.reset();
    if (fresh_line && !moved)
        curve = {};
    else if (fresh_line || (curve.changed && curve_editable()))
        paint_curve();
}

void Studio::curve_wheel(const Event& e) {
    CurveInWork& curve = session_.curve;
    double& pressure = curve.points[static_cast<std::size_t>(curve.over)].pressure;
    pressure = std::clamp(pressure + 0.1 * e.steps, 0.0, 2.0);
    curve.changed = true;
    if (curve_editable()) paint_curve();
}

bool Studio::curve_key(const Event& e) {
    CurveInWork& curve = session_.curve;
    if (curve.points.empty()) return false;
    if (e.key == GLFW_KEY_ENTER || e.key == GLFW_KEY_KP_ENTER) {
        if (curve.changed || !curve.last_stroke)
            paint_curve();
        else
            curve = {};
    } else if (e.key == GLFW_KEY_ESCAPE) {
        curve = {};
        line_start_.reset();
    } else if ((e.key == GLFW_KEY_BACKSPACE || e.key == GLFW_KEY_DELETE) && session_.tool == Tool::curve) {
        curve.points.erase(curve.points.begin() +
                           (curve.over >= 0 ? curve.over : static_cast<int>(curve.points.size()) - 1));
        curve.over = curve.grabbed = -1;
        curve.changed = true;
        if (curve.points.size() < 2 && curve.last_stroke)
            curve = {};
        else if (curve_editable())
            paint_curve();
    } else {
        return false;
    }
    return true;
}

// Of the brush in hand; found anew where it is another one.
TipLag Studio::tip_lag(const brush::Preset& preset) {
    if (tip_lag_brush_ != session_.brush) {
        tip_lag_ = stroke::measure_tip_lag(preset);
        tilted_tip_lag_.emplace(preset);
        tip_lag_brush_ = session_.brush;
    }
    return {tip_lag_, [this](double depth, const Vec2& lean) { return tilted_tip_lag_->at(depth, lean); }};
}

// Paints it, in the place of what was painted before when that is the last stroke.
void Studio::paint_curve() {
    Session& s = session_;
    CurveInWork& curve = s.curve;
    if (curve.points.size() < 2) return;
    const brush::Preset preset = brush::load_preset(s.brush);
    const TipLag lag = tip_lag(preset);
    const render::GlCamera c = camera();
    CurveHand hand{.hold = stroke::holder_options(preset, s.painter->model().query->mesh()),
                   .settings = s.curve_settings,
                   .pressure = s.hand.pressure,
                   .tilt = {s.hand.tilt.x, -s.hand.tilt.y},
                   .right = c.right,
                   .down = -c.up};
    hand.hold.tip_lag = lag.upright;
    hand.hold.leaned = lag.leaned;
    const auto strokes = curve_poses(*s.painter->model().query, curve.points, hand);
    if (strokes.empty()) return say(s, "The line does not lie on the model.");
    if (curve_editable()) s.painter->post(UndoStroke{});
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        BeginStroke begin = stroke_to_begin();
        begin.joined = i > 0;
        s.painter->post(std::move(begin));
        s.painter->post(ExtendStroke{strokes[i], now_});
        s.painter->post(EndStroke{});
    }
    curve.changed = false;
    curve.waits = true;
    curve.last_stroke = 0;
}

void Studio::watch_curve() {
    Session& s = session_;
    CurveInWork& curve = s.curve;
    if (curve.waits && s.painter->idle() && s.last.waiting == 0) {
        curve.waits = false;
        curve.last_stroke = s.strokes.empty() ? 0 : s.strokes.back().id;
    }
    // Undone, or something was painted after it: it is history now.
    if (curve.last_stroke && !curve_editable() && settled(s)) curve = {};
    const bool tool = s.tool == Tool::line || s.tool == Tool::curve;
    if (!tool && !curve.points.empty()) curve = {};
    if (curve.grabbed < 0) curve.over = tool && cursor_inside_ ? curve_point_at(cursor_) : -1;
}

}  // namespace tuft::app
