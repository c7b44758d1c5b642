#include "cli/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "contact/outside.h"
#include "core/units.h"
#include "stroke/hand/drawing.h"
#include "stroke/hand/room.h"

namespace tuft::cli {

namespace {

// Surfaces with more of the normal along z lie: they are looked at from above, not from where they face.
constexpr double kLies = 0.8;

void note_widths(const stroke::WidthMismatch& m, Console& console) {
    if (m.brush.empty()) return;
    const std::string asked = m.most > m.least ? fmt::format("{:.3g} to {:.3g}", m.least / kMillimetre, m.most / kMillimetre) : fmt::format("{:.3g}", m.most / kMillimetre);
    console.note(fmt::format("the drawing has lines {} mm wide; {} draws {:.2g} to {:.2g} mm (without --brush, or with --fit-brush, it is made to fit)",
                             asked, m.brush, m.thinnest / kMillimetre, m.widest / kMillimetre));
}

constexpr double kTooLarge = 3;  // diagonals of the model

double extent_along(const Box& box, const Vec3& direction) {
    return glm::dot(box.size(), glm::abs(direction));
}

void lay_drawing(std::vector<stroke::Stroke>& strokes, const stroke::Model& model, const Paint& a, const stroke::BrushFit& fit, stroke::WidthTables& widths, Console& console) {
    for (stroke::Stroke& s : strokes) {
        if (s.layer == stroke::kPaletteLayer) continue;  // in its own frame
        if (!s.trace.placed) s.trace.placement.laying = stroke::Laying::drape;
        if (const auto laying = stroke::laying_named(a.laying)) s.trace.placement.laying = *laying;
    }
    const std::vector<stroke::Trace*> drawing = stroke::drawing_in(strokes, !a.place_mm.empty());
    if (drawing.empty()) return stroke::choose_brushes(strokes, {}, 1, 0, fit, widths);
    stroke::arrange_parts(drawing);
    const Box area = stroke::extent_of(drawing);
    const Box& box = model.mesh->bounds;
    // What lies flat, such as a sheet or a plate, is written on from above.
    const bool lies = box.size().z < 0.25 * std::min(box.size().x, box.size().y);
    const Vec3 look = lies ? Vec3{0, 0, -1} : Vec3{0, 1, 0}, before = box.centre() - box.diagonal() * look;
    const double turn = a.place_turn_deg * kDegree, width = stroke::width_of(area);
    double scale = a.place_width_mm > 0 && width > 0 ? a.place_width_mm * kMillimetre / width : 1;
    std::optional<mesh::SurfacePoint> at;
    Vec3 normal;
    std::string note;
    if (a.place_mm.empty()) {
        const Vec2 size = std::abs(std::cos(turn)) * Vec2(area.size()) + std::abs(std::sin(turn)) * Vec2(area.size().y, area.size().x);
        const stroke::Placement seen = stroke::upright_placement({}, -look, 0);
        const double fill = std::max(size.x / extent_along(box, seen.right), size.y / extent_along(box, seen.down));
        if (a.place_width_mm <= 0 && fill > 0 && (fill > 1 || fill < 0.01)) scale = 0.6 / fill;
        if (const auto room = stroke::find_room(*model.query, look, scale * size)) {
            at = room->at, normal = room->normal;
            if (a.place_width_mm <= 0) scale *= room->scale;
        } else {
            if (at = model.query->ray(before, look); !at) at = model.query->closest_point(before);
            normal = at->normal;
        }
        if (scale != 1 && a.place_width_mm <= 0)
            note = fmt::format("; they are written {:.4g} mm wide and painted {:.4g} mm wide{} (see --place-width, --brush)", area.size().x / kMillimetre,
                               scale * area.size().x / kMillimetre, a.brush.empty() ? " with brushes of that scale" : "");
    } else {
        const Vec3 place = kMillimetre * Vec3(a.place_mm[0], a.place_mm[1], a.place_mm[2]);
        at = model.query->closest_point(place);
        normal = at->normal;
        if (const double inside = contact::depth_inside(*model.query, place); inside > kInsideNoted)
            console.note(fmt::format("warning: --place {:.4g},{:.4g},{:.4g} lies {:.2f} mm inside the model; the drawing goes to the nearest place of its surface, {:.1f},{:.1f},{:.1f} mm",
                                     a.place_mm[0], a.place_mm[1], a.place_mm[2], inside / kMillimetre, at->position.x / kMillimetre, at->position.y / kMillimetre, at->position.z / kMillimetre));
    }
    if (a.place_mm.empty())
        console.note(fmt::format("the strokes name no place; they go to the {} of the model, at {:.1f},{:.1f},{:.1f} mm (see --place){}",
                                 lies ? "top" : "front", at->position.x / kMillimetre, at->position.y / kMillimetre, at->position.z / kMillimetre, note));
    if (const double large = scale * std::max(area.size().x, area.size().y); large > kTooLarge * box.diagonal())
        console.note(fmt::format("the drawing is {:.4g} mm large, the model {:.4g} mm: most of it meets no surface (see --place-width, --unit)",
                                 large / kMillimetre, box.diagonal() / kMillimetre));
    const stroke::DrawingPlace place{stroke::upright_placement(at->position, normal, turn, a.place_mirror), Vec2(area.centre()), scale};
    stroke::place_drawing(drawing, place);
    stroke::choose_brushes(strokes, drawing, scale, scale * std::max(area.size().x, area.size().y), fit, widths);
}

}  // namespace

void place_strokes(std::vector<stroke::Stroke>& strokes, const stroke::Model& model, const Paint& a,
                   Console& console) {
    stroke::WidthTables widths;
    const bool chosen = !a.brush.empty();
    lay_drawing(strokes, model, a, {.grow = !chosen, .fit = !chosen || a.fit_brush}, widths, console);
    note_widths(stroke::press_to_widths(strokes, widths), console);
}

void look_at_strokes(View& view, const std::vector<stroke::Stroke>& strokes, const stroke::Model& model) {
    Vec3 sum{0}, up{0};
    double count = 0;
    for (const stroke::Stroke& s : strokes) {
        if (s.action != stroke::Action::stroke || s.trace.samples.empty() || s.layer == stroke::kPaletteLayer) continue;
        const auto weight = static_cast<double>(s.trace.samples.size());
        const Vec3 at = s.trace.flat ? s.trace.placement.origin : s.trace.samples[s.trace.samples.size() / 2].position;
        if (const auto near = model.query->closest_point(at)) sum += weight * near->face_normal;
        if (s.trace.flat) up -= weight * glm::normalize(s.trace.placement.down);
        count += weight;
    }
    if (!(glm::length(sum) > 0.7 * count)) return;  // they go round the model, or there are none
    const Vec3 n = glm::normalize(sum);
    // On what lies nearly flat the drawing says from which of the four sides it is read, not the slope.
    if (std::abs(n.z) > kLies && std::hypot(up.x, up.y) > 0.5 * count)
        view.azimuth = 90 * std::round(std::atan2(-up.x, up.y) / kDegree / 90);
    else if (std::hypot(n.x, n.y) > 0.1) view.azimuth = std::atan2(n.x, -n.y) / kDegree;
    view.elevation = std::clamp(std::asin(n.z) / kDegree + 10, -80.0, 80.0);
    // A wall that leans out is looked at from above the ground, as it stands; an underside from below.
    if (n.z > -0.7) view.elevation = std::max(view.elevation, 5.0);
}

}  // namespace tuft::cli
