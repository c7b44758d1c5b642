#include "app/tools/curve_tool.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/tools/aim.h"
#include "app/tools/stroke_input.h"
#include "brush/tuft/ferrule.h"

namespace tuft::app {
namespace {

constexpr double kGrab = 11;     // pixels round a control point, at a scale of 1
constexpr double kShortest = 3;  // pixels of a line
constexpr double kSnap = std::numbers::pi / 12;

}  // namespace

// The control point under the cursor, -1: none.
int CurveTool::point_at(const Event& e) const {
    const Session& s = session_;
    const render::GlCamera c = camera_of(session_);
    int nearest = -1;
    double least = kGrab * static_cast<double>(s.ui.settings().scale);
    for (std::size_t i = 0; i < s.tools.curve.points.size(); ++i) {
        const Vec3 at = render::picture_point(c, s.tools.curve.points[i].position);
        const double away = std::hypot(at.x + s.view.area.x - e.x, at.y + s.view.area.y - e.y);
        if (away < least) least = away, nearest = static_cast<int>(i);
    }
    return nearest;
}

std::optional<CurvePoint> CurveTool::point_of(const Event& e) const {
    const Aim aim = aim_of(session_, e);
    const mesh::SurfaceQuery& query = session_.paint_thread->surface();
    const auto hit = aim_at(query, aim);
    if (!hit || is_through_a_hole(query, *hit, aim)) return std::nullopt;
    return CurvePoint{.position = hit->position, .outward = -aim.ray.direction};
}

bool CurveTool::editable() const {
    const Session& s = session_;
    return s.tools.curve.last_stroke != 0 && !s.journal.lines.empty() &&
           s.journal.lines.back().id == s.tools.curve.last_stroke;
}

void CurveTool::press(const Event& e) {
    CurveInWork& curve = session_.tools.curve;
    curve.grabbed = point_at(e);
    if (curve.grabbed >= 0) return;
    const auto point = point_of(e);
    if (!point) return;
    // A painted line or curve is done when a new one is begun.
    if (session_.tools.active == Tool::line || curve.last_stroke || curve.is_pending) curve = {};
    curve.points.push_back(*point);
    if (session_.tools.active == Tool::line) curve.points.push_back(*point);
    curve.grabbed = static_cast<int>(curve.points.size()) - 1;
    line_start_ = e;
}

void CurveTool::drag(const Event& e) {
    CurveInWork& curve = session_.tools.curve;
    if (curve.grabbed < 0) return;
    CurvePoint& grabbed = curve.points[static_cast<std::size_t>(curve.grabbed)];
    Event at = e;
    if ((e.modifiers & kShift) && curve.points.size() >= 2) {
        // Steps of 15° round the neighbour, as seen.
        const std::size_t other = curve.grabbed > 0 ? static_cast<std::size_t>(curve.grabbed) - 1 : 1;
        const Vec3 pivot = render::picture_point(camera_of(session_), curve.points[other].position);
        const double x = e.x - session_.view.area.x - pivot.x, y = e.y - session_.view.area.y - pivot.y;
        const double angle = kSnap * std::round(std::atan2(y, x) / kSnap),
                     length = x * std::cos(angle) + y * std::sin(angle);
        at.x = pivot.x + session_.view.area.x + length * std::cos(angle);
        at.y = pivot.y + session_.view.area.y + length * std::sin(angle);
    }
    if (auto point = point_of(at)) {
        point->pressure = grabbed.pressure;
        grabbed = *point;
        curve.changed = true;
    }
}

void CurveTool::release(const Event& e, double now) {
    CurveInWork& curve = session_.tools.curve;
    const bool fresh_line = session_.tools.active == Tool::line && line_start_ && !curve.last_stroke;
    const bool moved = line_start_ && std::hypot(e.x - line_start_->x, e.y - line_start_->y) >= kShortest;
    curve.grabbed = -1;
    line_start_.reset();
    if (fresh_line && !moved)
        curve = {};
    else if (fresh_line || (curve.changed && editable()))
        paint(now);
}

void CurveTool::wheel(const Event& e, double now) {
    CurveInWork& curve = session_.tools.curve;
    double& pressure = curve.points[static_cast<std::size_t>(curve.over)].pressure;
    pressure = std::clamp(pressure + 0.1 * e.steps, 0.0, 2.0);
    curve.changed = true;
    if (editable()) paint(now);
}

bool CurveTool::key(const Event& e, double now) {
    CurveInWork& curve = session_.tools.curve;
    if (curve.points.empty()) return false;
    if (e.key == GLFW_KEY_ENTER || e.key == GLFW_KEY_KP_ENTER) {
        if (curve.changed || !curve.last_stroke)
            paint(now);
        else
            curve = {};
    } else if (e.key == GLFW_KEY_ESCAPE) {
        curve = {};
        line_start_.reset();
    } else if ((e.key == GLFW_KEY_BACKSPACE || e.key == GLFW_KEY_DELETE) && session_.tools.active == Tool::curve) {
        curve.points.erase(curve.points.begin() +
                           (curve.over >= 0 ? curve.over : static_cast<int>(curve.points.size()) - 1));
        curve.over = curve.grabbed = -1;
        curve.changed = true;
        if (curve.points.size() < 2 && curve.last_stroke)
            curve = {};
        else if (editable())
            paint(now);
    } else {
        return false;
    }
    return true;
}

// Paints it, in the place of what was painted before when that is the last stroke.
void CurveTool::paint(double now) {
    Session& s = session_;
    CurveInWork& curve = s.tools.curve;
    if (curve.points.size() < 2) return;
    const brush::Preset preset = brush::load_preset(s.brush.preset);
    const BrushTipLag lag = tip_lag_.find(preset);
    const render::GlCamera c = camera_of(session_);
    CurveHand hand{.holder = stroke::holder_options(preset, s.paint_thread->surface().mesh()),
                   .settings = s.tools.curve_settings,
                   .pressure = s.tools.pointer.pressure,
                   .tilt = {s.tools.pointer.tilt.x, -s.tools.pointer.tilt.y},
                   .roll = brush::can_be_turned(preset) ? s.tools.pointer.roll : 0,
                   .roll_follow = brush::can_be_turned(preset) && s.tools.pointer.roll_follow,
                   .right = c.right,
                   .down = -c.up};
    hand.holder.tip_lag = lag.upright;
    hand.holder.tip_lag_change = lag.tilted;
    const auto strokes = curve_poses(s.paint_thread->surface(), curve.points, hand);
    if (strokes.empty()) return show_message(s.status, "The line does not lie on the model.");
    if (editable()) s.paint_thread->post(UndoStroke{});
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        BeginStroke begin = stroke_to_begin(s);
        begin.joined = i > 0;
        s.paint_thread->post(std::move(begin));
        s.paint_thread->post(ExtendStroke{strokes[i], now});
        s.paint_thread->post(EndStroke{});
    }
    curve.changed = false;
    curve.is_pending = true;
    curve.last_stroke = 0;
}

void CurveTool::watch(const Event* cursor) {
    Session& s = session_;
    CurveInWork& curve = s.tools.curve;
    if (curve.is_pending && s.paint_thread->idle() && s.reported.progress.waiting == 0) {
        curve.is_pending = false;
        curve.last_stroke = s.journal.lines.empty() ? 0 : s.journal.lines.back().id;
    }
    // Undone, or something was painted after it: it is history now.
    if (curve.last_stroke && !editable() && is_settled(s)) curve = {};
    const bool tool = s.tools.active == Tool::line || s.tools.active == Tool::curve;
    if (!tool && !curve.points.empty()) {
        if (curve.points.size() > 1) s.tools.lettering.curve = std::move(curve.points);
        curve = {};
    }
    if (curve.grabbed < 0) curve.over = tool && cursor ? point_at(*cursor) : -1;
}

}  // namespace tuft::app
