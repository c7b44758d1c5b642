#include "cli/steps/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cli/steps/drawing.h"
#include "contact/node_contact.h"
#include "core/error.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"
#include "stroke/drawing/free_area.h"
#include "stroke/placement/snap.h"

namespace tuft::cli {

namespace {

// Surfaces with more of the normal along z lie: they are looked at from above, not from where they face.
constexpr double kLies = 0.8;

void note_widths(const stroke::WidthMismatch& m, bool fitted, Console& console) {
    if (m.brush.empty()) return;
    const std::string wanted = m.most > m.least
                                   ? fmt::format("{:.3g} to {:.3g}", m.least / kMillimetre, m.most / kMillimetre)
                                   : fmt::format("{:.3g}", m.most / kMillimetre);
    console.note(fmt::format(
        "the drawing has lines {} mm wide that {} does not draw: its lines are {:.2g} to {:.2g} mm wide ({})", wanted,
        m.brush, m.thinnest / kMillimetre, m.widest / kMillimetre,
        fitted ? "no size of it fits; another --brush may" : "--fit-brush takes a size of it that fits"));
}

/// A point for the middle of a drawing, and the normal that it is laid out across.
struct Spot {
    mesh::SurfacePoint at;
    Vec3 normal{0, 0, 1};
};

/// Its middle at a point that was named.
Spot named_spot(const stroke::Model& model, const Paint& a, Console& console) {
    const Vec3 place = kMillimetre * vector_of(a.place.at_mm);
    const auto at = model.query->closest_point(place);
    if (const double inside = contact::depth_inside(*model.query, place);
        inside > place_inside_noted(model.mesh->bounds))
        console.note(
            fmt::format("warning: --place {:.4g},{:.4g},{:.4g} lies {:.2f} mm inside the model; the drawing goes to "
                        "the nearest place of its surface, {:.1f},{:.1f},{:.1f} mm",
                        a.place.at_mm[0], a.place.at_mm[1], a.place.at_mm[2], inside / kMillimetre,
                        at->position.x / kMillimetre, at->position.y / kMillimetre, at->position.z / kMillimetre));
    else if (const double beside = glm::distance(place, Vec3(at->position));
             beside > stroke::kFarBeside * model.mesh->bounds.diagonal())
        console.note(
            fmt::format("warning: --place {:.4g},{:.4g},{:.4g} lies {:.1f} mm beside the model; the drawing goes to "
                        "the nearest place of its surface, {:.1f},{:.1f},{:.1f} mm",
                        a.place.at_mm[0], a.place.at_mm[1], a.place.at_mm[2], beside / kMillimetre,
                        at->position.x / kMillimetre, at->position.y / kMillimetre, at->position.z / kMillimetre));
    return {*at, at->normal};
}

/// On a side, and how large: where it is not said as it is written, if that suits the largest calm area, else as a part
/// of it.
Spot free_spot(const stroke::Model& model, const Paint& a, const Vec2& size, double& scale, PlacedDrawing& placed) {
    const stroke::Side side = stroke::side_named(a.place.on).value_or(stroke::usual_side(model.mesh->bounds));
    placed.side = stroke::side_name(side);
    const auto free = stroke::find_free_area(*model.query, side, std::max(size.x, 1e-9) / std::max(size.y, 1e-9));
    if (!free) {
        if (!a.place.on.empty())
            throw Error(fmt::format(
                "{}: no calm area is found on its {}{}", a.model.string(), placed.side,
                side == stroke::Side::inside ? " (the inside is looked for from above, within walls)" : ""));
        const Vec3 look = stroke::look_at_side(side),
                   before = model.mesh->bounds.centre() - model.mesh->bounds.diagonal() * look;
        auto at = model.query->ray(before, look);
        if (!at) at = model.query->closest_point(before);
        return {*at, at->normal};
    }
    placed.free = free->size;
    const auto part = [&] { return scale * std::max(size.x / free->size.x, size.y / free->size.y); };
    if (a.place.width_mm <= 0 && part() > 0 && (part() > stroke::kMostPart || part() < stroke::kLeastPart))
        scale *= stroke::kUsualPart / part();
    placed.part = part();
    return {free->at, free->normal};
}

/// In the middle plane of the model, near the spot.
Spot snapped_spot(const stroke::Model& model, const Paint& a, const Spot& spot) {
    if (a.place.snap.empty()) return spot;
    const Box& box = model.mesh->bounds;
    const int axis = a.place.snap[0] - 'x';
    if (const auto side = stroke::side_named(a.place.on); side && std::abs(stroke::look_at_side(*side)[axis]) > 0.5)
        throw UsageError(fmt::format("--snap {} puts the drawing beside the {} side, which --on asks for", a.place.snap,
                                     a.place.on));
    stroke::SnapPlane plane{.through = box.centre(), .normal = Vec3(0)};
    plane.normal[axis] = 1;
    const auto at = stroke::surface_point_in_plane(*model.query, spot.at.position, plane, box.diagonal());
    if (!at)
        throw Error(a.model.string(),
                    Message("no surface near the place lies in the middle plane across {} (see --snap)", a.place.snap));
    return {*at, glm::dot(at->normal, spot.normal) < 0 ? -at->normal : at->normal};
}

/// Scale of a drawing for a wanted width. One that has it stays as it is, to the bit.
double scale_to(double wanted, double width) {
    constexpr double kSame = 1e-12;
    const double scale = wanted / width;
    return std::abs(scale - 1) < kSame ? 1 : scale;
}

/// Which way up it is read.
stroke::Placement placement_at(const Spot& spot, const Paint& a, bool project) {
    const double turn = a.place.turn_deg * kDegree;
    if (a.place.read_from.empty()) return stroke::upright_placement(spot.at.position, spot.normal, turn);
    const Vec3 from = vector_of(a.place.read_from);
    return stroke::placement_seen(spot.at.position, project ? glm::normalize(from) : spot.normal,
                                  stroke::reading_right(from), turn);
}

void note_placed(const PlacedDrawing& p, const Paint& a, const Box& area, double scale, Console& console) {
    std::string line = fmt::format("{} the {} of the model, at {:.1f},{:.1f},{:.1f} mm",
                                   a.place.on.empty() ? "the strokes name no place; they go to" : "the strokes go to",
                                   p.side, p.at.x / kMillimetre, p.at.y / kMillimetre, p.at.z / kMillimetre);
    if (p.part > 0)
        line += fmt::format(", the middle of its largest calm area, {:.4g} x {:.4g} mm, of which they take {:.0f} %",
                            p.free.x / kMillimetre, p.free.y / kMillimetre, 100 * p.part);
    line += " (see --place, --on)";
    if (scale != 1 && a.place.width_mm <= 0)
        line +=
            fmt::format("; they are written {:.4g} mm wide and painted {:.4g} mm wide{} (see --place-width, --brush)",
                        area.size().x / kMillimetre, scale * area.size().x / kMillimetre,
                        a.stroke.brush.empty() ? " with brushes of that scale" : "");
    console.note(line);
}

std::optional<PlacedDrawing> place_on_model(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                            const Paint& a, stroke::PlacedTraces& traces, Console& console) {
    set_mappings(strokes, a);
    const bool all = !a.place.at_mm.empty() || !a.place.on.empty();
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(strokes, all);
    const std::vector<stroke::FlatArea*> areas = stroke::areas_in(strokes, all);
    if (drawing.empty() && areas.empty()) return {};
    stroke::arrange_parts(drawing);
    Box area = stroke::extent_of(drawing);
    for (const stroke::FlatArea* part : areas) stroke::add_extent(area, *part);
    const double turn = a.place.turn_deg * kDegree, width = stroke::width_of(area);
    double scale = a.place.width_mm > 0 && width > 0 ? scale_to(a.place.width_mm * kMillimetre, width) : 1;
    PlacedDrawing placed;
    const Vec2 size =
        std::abs(std::cos(turn)) * Vec2(area.size()) + std::abs(std::sin(turn)) * Vec2(area.size().y, area.size().x);
    const Spot spot = snapped_spot(
        model, a, a.place.at_mm.empty() ? free_spot(model, a, size, scale, placed) : named_spot(model, a, console));
    placed.at = spot.at.position;
    placed.normal = spot.normal;
    placed.size = scale * Vec2(area.size());
    if (a.place.at_mm.empty()) note_placed(placed, a, area, scale, console);
    const stroke::SurfaceMapping first =
        drawing.empty() ? areas.front()->placement.mapping : drawing.front()->placement.mapping;
    const stroke::DrawingPlace place{placement_at(spot, a, first == stroke::SurfaceMapping::project),
                                     Vec2(area.centre()), scale, a.place.mirror};
    stroke::place_drawing(drawing, place);
    stroke::place_areas(areas, place);
    traces = {drawing, scale, scale * std::max(area.size().x, area.size().y)};
    return placed;
}

}  // namespace

void set_mappings(std::vector<stroke::JournalEntry>& strokes, const Paint& a) {
    const auto mapping = stroke::surface_mapping_named(a.place.edges == "wrap" ? "wrap" : a.place.mapping);
    for (stroke::FlatArea* area : stroke::areas_in(strokes, true)) {
        if (!area->placed) area->placement.mapping = stroke::SurfaceMapping::drape;
        if (mapping) area->placement.mapping = *mapping;
    }
    for (stroke::JournalEntry& entry : strokes) {
        stroke::PaintStroke* s = entry.as<stroke::PaintStroke>();
        if (!s || s->layer == stroke::kPaletteLayer) continue;  // in its own frame
        if (!s->trace.placed) s->trace.placement.mapping = stroke::SurfaceMapping::drape;
        if (mapping) s->trace.placement.mapping = *mapping;
    }
}

void finish_strokes(std::vector<stroke::JournalEntry>& strokes, const stroke::PlacedTraces& drawing, const Paint& a,
                    Console& console) {
    stroke::WidthTables widths;
    const bool chosen = !a.stroke.brush.empty();
    const stroke::BrushFit fit{.grow = !chosen, .fit = !chosen || a.drawing.fit_brush};
    stroke::choose_brushes(strokes, drawing, fit, widths);
    stroke::fill_wide_lines(strokes, a.drawing.wide_lines_mm * kMillimetre, edges_of(a));
    stroke::redip_long_lines(strokes, fit, widths);
    note_widths(stroke::press_to_widths(strokes, widths), fit.fit, console);
}

std::optional<PlacedDrawing> place_strokes(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                           const Paint& a, Console& console) {
    stroke::PlacedTraces traces;
    const std::optional<PlacedDrawing> placed = place_on_model(strokes, model, a, traces, console);
    finish_strokes(strokes, traces, a, console);
    return placed;
}

void look_at_strokes(View& view, const std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model) {
    Vec3 sum{0}, up{0};
    double count = 0;
    for (const stroke::JournalEntry& s : strokes) {
        const stroke::StrokeSamples& trace = stroke::samples_of(s);
        if (const stroke::Fill* fill = s.as<stroke::Fill>(); fill && fill->area) {
            if (const auto near = model.query->closest_point(fill->area->placement.origin)) sum += near->face_normal;
            up -= glm::normalize(fill->area->placement.down);
            count += 1;
            continue;
        }
        if (trace.samples.empty() || stroke::on_palette(s)) continue;
        const auto weight = static_cast<double>(trace.samples.size());
        const Vec3 at = trace.flat ? trace.placement.origin : trace.samples[trace.samples.size() / 2].position;
        if (const auto near = model.query->closest_point(at)) sum += weight * near->face_normal;
        if (trace.flat) up -= weight * glm::normalize(trace.placement.down);
        count += weight;
    }
    if (!(glm::length(sum) > 0.7 * count)) return;  // they go round the model, or there are none
    const Vec3 n = glm::normalize(sum);
    // On what lies nearly flat the drawing says from which of the four sides it is read, not the slope.
    if (std::abs(n.z) > kLies && std::hypot(up.x, up.y) > 0.5 * count)
        view.azimuth = 90 * std::round(std::atan2(-up.x, up.y) / kDegree / 90);
    else if (std::hypot(n.x, n.y) > 0.1)
        view.azimuth = std::atan2(n.x, -n.y) / kDegree;
    view.elevation = std::clamp(std::asin(n.z) / kDegree + 10, -80.0, 80.0);
    // A wall that leans out is looked at from above the ground, as it stands; an underside from below.
    if (n.z > -0.7) view.elevation = std::max(view.elevation, 5.0);
}

}  // namespace tuft::cli
