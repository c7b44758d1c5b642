#include "app/tools/writing_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/tools/aim.h"
#include "core/text/units.h"

namespace tuft::app {

stroke::Placement WritingTool::placement_at(const PlacingSpot& spot) const {
    const Session& s = session_;
    return place_writing(s.tools.writing, s.paint_thread->surface(), spot.at, spot.normal, camera_of(s).right,
                         spot.eye);
}

void WritingTool::watch(const Event* cursor) {
    Session& s = session_;
    if (s.tools.active != Tool::writing) {
        scale_ = 0;
        return;
    }
    if (std::exchange(s.tools.place.is_typed, false) && !s.tools.writing.empty())
        if (const auto typed = typed_spot(s)) place(*typed);
    const auto spot = s.tools.writing.empty() ? std::nullopt : spot_at(s, cursor);
    s.tools.place.guides.clear();
    if (!spot) {
        s.tools.place.preview.clear();
        scale_ = 0;
        return;
    }
    s.tools.place.guides = spot->guides;
    const stroke::Placement at = placement_at(*spot);
    show_place(s.tools, at.origin);
    const stroke::Placement& old = placement_;
    const render::GlCamera seen_from = camera_of(s);
    const Vec4f section = section_plane(s.view, s.paint_thread->model().mesh->bounds);
    const bool same = at.origin == old.origin && at.right == old.right && at.down == old.down &&
                      at.mapping == old.mapping && scale_ == s.tools.writing.scale;
    if (same && seen_from == camera_ && section == section_) return;
    placement_ = at;
    scale_ = s.tools.writing.scale;
    camera_ = seen_from;
    section_ = section;
    if (!same) s.tools.place.preview = preview_lines(s.paint_thread->surface(), s.tools.writing, at);
    find_seen(s.tools.place.preview, s);
}

void WritingTool::wheel(const Event& e) {
    Writing& w = session_.tools.writing;
    if (e.modifiers & kShift)
        w.turn = std::remainder(w.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else
        w.scale = std::clamp(w.scale * std::pow(1.05, e.steps), 1e-3, 1e3);
}

void WritingTool::place(const Event* cursor) {
    if (session_.tools.writing.empty()) return;
    if (const auto at = spot_at(session_, cursor)) place(*at);
}

void WritingTool::place(const PlacingSpot& spot) {
    Session& s = session_;
    const stroke::Placement at = placement_at(spot);
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush.preset, s.brush.ink, s.tools.pointer.pressure / PointerSettings{}.pressure};
    show_message(s.status, Message("Placed: {}", place_words(s.tools.writing, at)));
    s.paint_thread->post(PaintDrawing{placed_writing(s.tools.writing, at, hand),
                                      group_settings(s, stroke::group_name(s.tools.writing.file))});
}

}  // namespace tuft::app
