#include <algorithm>
#include <cmath>

#include "app/studio.h"
#include "core/units.h"

/// Placing writing and drawings with the mouse.
namespace tuft::app {

std::optional<stroke::Placement> Studio::writing_placement() const {
    const Session& s = session_;
    if (s.tool != Tool::writing || s.writing.empty() || !cursor_inside_ || dialog_open()) return std::nullopt;
    const Aim aim = aim_of(cursor_);
    const auto hit = aim_at(*s.painter->model().query, aim);
    if (!hit) return std::nullopt;
    const Vec3 normal = glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal;
    stroke::Placement placement = place_writing(s.writing, *s.painter->model().query, hit->position, normal, aim.view_right);
    if (s.writing.laying == stroke::Laying::project) {
        // Straight through the picture: as it is seen now it comes to lie.
        const double c = std::cos(s.writing.turn), t = std::sin(s.writing.turn);
        placement.right = (s.writing.mirrored ? -1.0 : 1.0) * (c * aim.view_right - t * aim.view_up);
        placement.down = -t * aim.view_right - c * aim.view_up;
    }
    return placement;
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
    if (placement->origin == old.origin && placement->right == old.right && placement->down == old.down && placement->laying == old.laying &&
        ghost_scale_ == s.writing.scale)
        return;
    ghost_placement_ = *placement;
    ghost_scale_ = s.writing.scale;
    s.ghost = ghost_lines(*s.painter->model().query, s.writing, *placement);
}

void Studio::writing_wheel(const Event& e) {
    Writing& w = session_.writing;
    if (e.modifiers & kShift) w.turn = std::remainder(w.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else w.scale = std::clamp(w.scale * std::pow(1.05, e.steps), 1e-3, 1e3);
}

void Studio::lay_writing() {
    Session& s = session_;
    const auto placement = writing_placement();
    if (!placement) return;
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush, s.ink, s.hand.pressure / HandSettings{}.pressure};
    say(s, s.ui.tr("Placed:") + (" " + place_words(s.writing, *placement)));
    s.painter->post(PaintDrawing{placed_writing(s.writing, *placement, hand), stroke::group_name(s.writing.file), s.symmetry, s.layer, s.mask, s.wet});
}

}  // namespace tuft::app
