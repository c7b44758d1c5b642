#include <algorithm>
#include <cmath>

#include "app/studio.h"
#include "app/view/visibility.h"
#include "core/text/units.h"

/// Placing writing and drawings with the mouse.
namespace tuft::app {
namespace {

constexpr double kGhostTolerance =
    2e-3;  // of the model's size: where it is seen edge-on, draped lines lie over its grooves

}  // namespace

std::optional<stroke::Placement> Studio::writing_placement() const {
    const Session& s = session_;
    if (s.tool != Tool::writing || s.writing.empty() || !cursor_inside_ || dialog_open()) return std::nullopt;
    const Aim aim = aim_of(cursor_);
    const auto hit = aim_at(*s.painter->model().query, aim);
    if (!hit) return std::nullopt;
    const Vec3 normal = glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal;
    return place_writing(s.writing, *s.painter->model().query, hit->position, normal, aim.view_right,
                         glm::cross(aim.view_right, aim.view_up));
}

void Studio::watch_writing() {
    Session& s = session_;
    const auto placement = writing_placement();
    if (!placement) {
        s.ghost.clear();
        ghost_scale_ = 0;
        return;
    }
    const stroke::Placement& old = ghost_placement_;
    const render::GlCamera seen_from = camera();
    const Vec4f section = section_plane(s);
    const bool same = placement->origin == old.origin && placement->right == old.right && placement->down == old.down &&
                      placement->mapping == old.mapping && ghost_scale_ == s.writing.scale;
    if (same && seen_from == ghost_camera_ && section == ghost_section_) return;
    ghost_placement_ = *placement;
    ghost_scale_ = s.writing.scale;
    ghost_camera_ = seen_from;
    ghost_section_ = section;
    const mesh::SurfaceQuery& query = *s.painter->model().query;
    if (!same) s.ghost = ghost_lines(query, s.writing, *placement);
    const double tolerance = kGhostTolerance * s.painter->model().mesh->bounds.diagonal();
    for (auto& line : s.ghost)
        for (GhostPoint& point : line) point.seen = is_seen(query, seen_from, section, point.position, tolerance);
}

void Studio::writing_wheel(const Event& e) {
    Writing& w = session_.writing;
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
    const WritingHand hand{s.brush, s.ink, s.hand.pressure / PointerSettings{}.pressure};
    say(s, s.ui.tr("Placed:") + (" " + place_words(s.writing, *placement)));
    s.painter->post(PaintDrawing{placed_writing(s.writing, *placement, hand), stroke::group_name(s.writing.file),
                                 s.symmetry, s.layer, s.mask, s.wet});
}

}  // namespace tuft::app
