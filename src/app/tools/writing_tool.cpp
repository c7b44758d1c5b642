#include "app/tools/writing_tool.h"

#include <algorithm>
#include <cmath>

#include "app/session/top_dialog.h"
#include "app/tools/aim.h"
#include "app/view/visibility.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

constexpr double kPreviewTolerance =
    2e-3;  // of the model's size: where it is seen edge-on, draped lines lie over its grooves

}  // namespace

std::optional<stroke::Placement> WritingTool::placement(const Event* cursor) const {
    const Session& s = session_;
    if (s.tools.active != Tool::writing || s.tools.writing.empty() || !cursor || is_dialog_open(s)) return std::nullopt;
    const Aim aim = aim_of(s, *cursor);
    const auto hit = aim_at(*s.paint_thread->model().query, aim);
    if (!hit || is_through_a_hole(*s.paint_thread->model().query, *hit, aim)) return std::nullopt;
    const Vec3 normal = glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal;
    return place_writing(s.tools.writing, *s.paint_thread->model().query, hit->position, normal, aim.view_right,
                         glm::cross(aim.view_right, aim.view_up));
}

void WritingTool::watch(const Event* cursor) {
    Session& s = session_;
    const auto at = placement(cursor);
    if (!at) {
        s.tools.writing_preview.clear();
        scale_ = 0;
        return;
    }
    const stroke::Placement& old = placement_;
    const render::GlCamera seen_from = camera_of(s);
    const Vec4f section = section_plane(s.view, s.paint_thread->model().mesh->bounds);
    const bool same = at->origin == old.origin && at->right == old.right && at->down == old.down &&
                      at->mapping == old.mapping && scale_ == s.tools.writing.scale;
    if (same && seen_from == camera_ && section == section_) return;
    placement_ = *at;
    scale_ = s.tools.writing.scale;
    camera_ = seen_from;
    section_ = section;
    const mesh::SurfaceQuery& query = *s.paint_thread->model().query;
    if (!same) s.tools.writing_preview = preview_lines(query, s.tools.writing, *at);
    const double tolerance = kPreviewTolerance * s.paint_thread->model().mesh->bounds.diagonal();
    for (auto& line : s.tools.writing_preview)
        for (PreviewPoint& point : line) point.seen = is_seen(query, seen_from, section, point.position, tolerance);
}

void WritingTool::wheel(const Event& e) {
    Writing& w = session_.tools.writing;
    if (e.modifiers & kShift)
        w.turn = std::remainder(w.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else
        w.scale = std::clamp(w.scale * std::pow(1.05, e.steps), 1e-3, 1e3);
}

void WritingTool::place(const Event* cursor) {
    Session& s = session_;
    const auto at = placement(cursor);
    if (!at) return;
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush.preset, s.brush.ink, s.tools.pointer.pressure / PointerSettings{}.pressure};
    show_message(s.status, Message("Placed: {}", place_words(s.tools.writing, *at)));
    s.paint_thread->post(PaintDrawing{placed_writing(s.tools.writing, *at, hand),
                                      stroke::group_name(s.tools.writing.file), s.tools.symmetry, s.layers.active,
                                      s.masks.active, s.brush.wet});
}

}  // namespace tuft::app
