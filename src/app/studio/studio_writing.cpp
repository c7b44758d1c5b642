#include <algorithm>
#include <cmath>

#include "app/session/top_dialog.h"
#include "app/studio/studio.h"
#include "app/view/visibility.h"
#include "core/units.h"

/// Placing writing and drawings with the mouse.
namespace tuft::app {
namespace {

constexpr double kGhostTolerance =
    2e-3;  // of the model's size: where it is seen edge-on, draped lines lie over its grooves

}  // namespace

std::optional<stroke::Placement> Studio::writing_placement() const {
    const Session& s = session_;
    if (s.tools.active != Tool::writing || s.tools.writing.empty() || !cursor_inside_ || is_dialog_open(session_))
        return std::nullopt;
    const Aim aim = aim_of(cursor_);
    const auto hit = aim_at(*s.paint_thread->model().query, aim);
    if (!hit) return std::nullopt;
    const Vec3 normal = glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal;
    return place_writing(s.tools.writing, *s.paint_thread->model().query, hit->position, normal, aim.view_right,
                         glm::cross(aim.view_right, aim.view_up));
}

void Studio::watch_writing() {
    Session& s = session_;
    const auto placement = writing_placement();
    if (!placement) {
        s.tools.writing_preview.clear();
        ghost_scale_ = 0;
        return;
    }
    const stroke::Placement& old = ghost_placement_;
    const render::GlCamera seen_from = camera();
    const Vec4f section = section_plane(s.view, s.paint_thread->model().mesh->bounds);
    const bool same = placement->origin == old.origin && placement->right == old.right && placement->down == old.down &&
                      placement->mapping == old.mapping && ghost_scale_ == s.tools.writing.scale;
    if (same && seen_from == ghost_camera_ && section == ghost_section_) return;
    ghost_placement_ = *placement;
    ghost_scale_ = s.tools.writing.scale;
    ghost_camera_ = seen_from;
    ghost_section_ = section;
    const mesh::SurfaceQuery& query = *s.paint_thread->model().query;
    if (!same) s.tools.writing_preview = ghost_lines(query, s.tools.writing, *placement);
    const double tolerance = kGhostTolerance * s.paint_thread->model().mesh->bounds.diagonal();
    for (auto& line : s.tools.writing_preview)
        for (GhostPoint& point : line) point.seen = is_seen(query, seen_from, section, point.position, tolerance);
}

void Studio::writing_wheel(const Event& e) {
    Writing& w = session_.tools.writing;
    if (e.modifiers & kShift)
        w.turn = std::remainder(w.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else
        w.scale = std::clamp(w.scale * std::pow(1.05, e.steps), 1e-3, 1e3);
}

void Studio::lay_writing() {
    Session& s = session_;
    const auto placement = writing_placement();
    if (!placement) return;
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush.preset, s.brush.ink, s.tools.pointer.pressure / PointerSettings{}.pressure};
    show_message(s.status, s.ui.tr("Placed:") + (" " + place_words(s.tools.writing, *placement)));
    s.paint_thread->post(PaintDrawing{placed_writing(s.tools.writing, *placement, hand),
                                      stroke::group_name(s.tools.writing.file), s.tools.symmetry, s.layers.active,
                                      s.masks.active, s.brush.wet});
}

}  // namespace tuft::app
