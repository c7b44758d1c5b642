#include "app/tools/writing_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/document/snapping.h"
#include "app/session/top_dialog.h"
#include "app/tools/aim.h"
#include "app/view/visibility.h"
#include "core/geometry/bounds.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"

namespace tuft::app {
namespace {

constexpr double kPreviewTolerance =
    2e-3;  // of the model's size: where it is seen edge-on, draped lines lie over its grooves

constexpr double kSnapPixels = 10;
constexpr double kShownPlace = 0.05;         // millimetres, half of the last digit of the fields
constexpr std::size_t kMostPlacements = 64;  // of the last drawings

// Of the drawings on the model, each once, the newest first.
std::vector<stroke::Placement> placements_in(const std::vector<StrokeLine>& lines) {
    std::vector<stroke::Placement> found;
    for (auto line = lines.rbegin(); line != lines.rend() && found.size() < kMostPlacements; ++line) {
        if (!line->placement || line->hidden) continue;
        const bool known = std::ranges::any_of(found, [&](const stroke::Placement& p) {
            return p.origin == line->placement->origin && p.right == line->placement->right;
        });
        if (!known) found.push_back(*line->placement);
    }
    return found;
}

}  // namespace

std::optional<WritingTool::Spot> WritingTool::spot(const Event* cursor) const {
    const Session& s = session_;
    if (s.tools.active != Tool::writing || s.tools.writing.empty() || !cursor || is_dialog_open(s)) return std::nullopt;
    const Aim aim = aim_of(s, *cursor);
    const mesh::SurfaceQuery& surface = s.paint_thread->surface();
    const auto hit = aim_at(surface, aim);
    if (!hit || is_through_a_hole(surface, *hit, aim)) return std::nullopt;
    Spot spot{hit->position, glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal,
              glm::cross(aim.view_right, aim.view_up)};
    if (!s.tools.snap || (cursor->modifiers & kControl)) return spot;
    const SnapTargets targets = snap_targets(s.tools.symmetry, surface.mesh().bounds, placements_in(s.journal.lines));
    if (auto snapped = snap(surface, spot.at, targets, kSnapPixels * aim.metres_per_pixel)) {
        const Vec3 normal = snapped->at.normal;
        spot.at = snapped->at.position;
        spot.normal = glm::dot(normal, spot.normal) < 0 ? -normal : normal;
        spot.guides = std::move(snapped->guides);
    }
    return spot;
}

std::optional<WritingTool::Spot> WritingTool::typed_spot() const {
    const Session& s = session_;
    if (s.tools.writing.empty()) return std::nullopt;
    const auto& mm = s.tools.place_mm;
    const Vec3 place = kMillimetre * Vec3(mm[0], mm[1], mm[2]);
    if (!within(place)) {
        show_message(session_.status, "That place is no three numbers within 10 km; nothing is placed");
        return std::nullopt;
    }
    const auto on = s.paint_thread->surface().closest_point(place);
    if (!on) return std::nullopt;
    if (on->distance > stroke::kFarBeside * s.paint_thread->surface().mesh().bounds.diagonal()) {
        show_message(session_.status, Message("That place lies {} mm beside the model; nothing is placed",
                                              std::lround(on->distance / kMillimetre)));
        return std::nullopt;
    }
    return Spot{on->position, on->normal, -camera_of(s).forward};
}

stroke::Placement WritingTool::placement_at(const Spot& spot) const {
    const Session& s = session_;
    return place_writing(s.tools.writing, s.paint_thread->surface(), spot.at, spot.normal, camera_of(s).right,
                         spot.eye);
}

void WritingTool::watch(const Event* cursor) {
    Session& s = session_;
    if (std::exchange(s.tools.place_typed, false))
        if (const auto typed = typed_spot()) place(*typed);
    const auto spot = this->spot(cursor);
    s.tools.snap_guides.clear();
    if (!spot) {
        s.tools.writing_preview.clear();
        scale_ = 0;
        return;
    }
    s.tools.snap_guides = spot->guides;
    const std::optional<stroke::Placement> at = placement_at(*spot);
    for (std::size_t k = 0; k < 3; ++k) {
        const double mm = at->origin[static_cast<int>(k)] / kMillimetre;
        s.tools.place_mm[k] = std::abs(mm) < kShownPlace ? 0 : mm;  // without the sign of -0.0
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
    const mesh::SurfaceQuery& query = s.paint_thread->surface();
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
    if (const auto at = spot(cursor)) place(*at);
}

void WritingTool::place(const Spot& spot) {
    Session& s = session_;
    const stroke::Placement at = placement_at(spot);
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush.preset, s.brush.ink, s.tools.pointer.pressure / PointerSettings{}.pressure};
    show_message(s.status, Message("Placed: {}", place_words(s.tools.writing, at)));
    s.paint_thread->post(PaintDrawing{placed_writing(s.tools.writing, at, hand),
                                      stroke::group_name(s.tools.writing.file), s.tools.symmetry, s.layers.active,
                                      s.masks.active, s.brush.wet});
}

}  // namespace tuft::app
