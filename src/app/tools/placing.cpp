#include "app/tools/placing.h"

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

std::optional<PlacingSpot> spot_at(const Session& s, const Event* cursor) {
    if (!cursor || is_dialog_open(s)) return std::nullopt;
    const Aim aim = aim_of(s, *cursor);
    const mesh::SurfaceQuery& surface = s.paint_thread->surface();
    const auto hit = aim_at(surface, aim);
    if (!hit || is_through_a_hole(surface, *hit, aim)) return std::nullopt;
    PlacingSpot spot{hit->position, glm::dot(hit->normal, aim.ray.direction) < 0 ? hit->normal : -hit->normal,
                     glm::cross(aim.view_right, aim.view_up)};
    if (!s.tools.place.snaps || (cursor->modifiers & kControl)) return spot;
    const SnapTargets targets = snap_targets(s.tools.symmetry, surface.mesh().bounds, placements_in(s.journal.lines));
    if (auto snapped = snap(surface, spot.at, targets, kSnapPixels * aim.metres_per_pixel)) {
        const Vec3 normal = snapped->at.normal;
        spot.at = snapped->at.position;
        spot.normal = glm::dot(normal, spot.normal) < 0 ? -normal : normal;
        spot.guides = std::move(snapped->guides);
    }
    return spot;
}

std::optional<PlacingSpot> typed_spot(Session& s) {
    const auto& mm = s.tools.place.millimetres;
    const Vec3 place = kMillimetre * Vec3(mm[0], mm[1], mm[2]);
    if (!within(place)) {
        show_message(s.status, "That place is no three numbers within 10 km; nothing is placed");
        return std::nullopt;
    }
    const auto on = s.paint_thread->surface().closest_point(place);
    if (!on) return std::nullopt;
    if (on->distance > stroke::kFarBeside * s.paint_thread->surface().mesh().bounds.diagonal()) {
        show_message(s.status, Message("That place lies {} mm beside the model; nothing is placed",
                                       std::lround(on->distance / kMillimetre)));
        return std::nullopt;
    }
    return PlacingSpot{on->position, on->normal, -camera_of(s).forward};
}

GroupSettings group_settings(const Session& s, const std::string& name) {
    return {name, s.tools.symmetry, s.layers.active, s.masks.active, s.brush.wet};
}

void show_place(ToolState& tools, const Vec3& at) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double mm = at[static_cast<int>(k)] / kMillimetre;
        tools.place.millimetres[k] = std::abs(mm) < kShownPlace ? 0 : mm;  // without the sign of -0.0
    }
}

void find_seen(std::vector<std::vector<PreviewPoint>>& lines, const Session& s) {
    const mesh::TriangleMesh& mesh = *s.paint_thread->model().mesh;
    const render::GlCamera camera = camera_of(s);
    const Vec4f section = section_plane(s.view, mesh.bounds);
    const double tolerance = kPreviewTolerance * mesh.bounds.diagonal();
    for (std::vector<PreviewPoint>& line : lines)
        for (PreviewPoint& point : line)
            point.seen = is_seen(s.paint_thread->surface(), camera, section, point.position, tolerance);
}

}  // namespace tuft::app
