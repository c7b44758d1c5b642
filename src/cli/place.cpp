#include "cli/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "brush/preset.h"
#include "core/units.h"
#include "stroke/hand/line_width.h"
#include "stroke/hand/practise.h"
#include "stroke/hand/room.h"

namespace tuft::cli {

namespace {

// Surfaces with more of the normal along z lie: they are written on and looked at from above, not from where they face.
constexpr double kLies = 0.8;

// Right and down of a drawing at a point: upright as somebody sees it who stands before the
// surface; on what lies, x stays to the right.
std::pair<Vec3, Vec3> upright(const Vec3& n, double turn) {
    const Vec3 right = std::abs(n.z) < kLies ? glm::normalize(glm::cross(Vec3{0, 0, 1}, n)) : make_frame(Vec3{0}, n).t;
    const Vec3 down = glm::cross(right, n);
    return {std::cos(turn) * right - std::sin(turn) * down, std::cos(turn) * down + std::sin(turn) * right};
}

constexpr const char* kBrush = "wolf-medium";  // where nothing names one
constexpr double kWriting = 0.06;              // metres of drawing that it suits

/// Whether the hand is to press as the drawing's line widths say.
bool has_width(const stroke::Stroke& s) {
    return s.action == stroke::Action::stroke && s.trace.flat && !s.trace.pressed && s.trace.line_width > 0 &&
           s.settings.pressure == "none";
}

/// Gives the drawing's brushes its scale, also for what is done with them before a stroke; the
/// one that nobody named suits its width. Where lines have widths, brushes come in sizes that draw them.
void size_brushes(std::vector<stroke::Stroke>& strokes, const std::vector<stroke::Trace*>& drawing, double scale, double width, stroke::WidthTables& widths) {
    std::string own, sized;
    for (auto s = strokes.rbegin(); s != strokes.rend(); ++s) {
        stroke::Trace& trace = s->trace;
        if (s->action == stroke::Action::stroke && s->layer != stroke::kPaletteLayer) {
            own = sized = trace.brush;
            if (std::find(drawing.begin(), drawing.end(), &trace) != drawing.end()) {
                const brush::SizedName name = brush::sized_name(own.empty() ? kBrush : own);
                sized = brush::name_of({name.base, own.empty() ? std::min(1.0, width / kWriting) : name.factor * scale});
            }
            if (has_width(*s)) sized = stroke::brush_for_width(sized, widths.of(sized), trace.line_width);
            trace.brush = sized;
        } else if (trace.brush == own) {
            trace.brush = sized;
        }
    }
}

void press_to_widths(std::vector<stroke::Stroke>& strokes, stroke::WidthTables& tables, Console& console) {
    double least = 1e30, most = 0;
    const stroke::Stroke* missed = nullptr;
    std::vector<stroke::Trace*> drawn;
    for (stroke::Stroke& s : strokes) {
        if (has_width(s)) {
            const stroke::LineWidths& widths = tables.of(s.trace.brush);
            stroke::draw_to_width(s.trace, widths);
            drawn.push_back(&s.trace);
            if (s.trace.line_width < widths.least() || s.trace.line_width > widths.most()) {
                missed = &s;
                least = std::min(least, s.trace.line_width), most = std::max(most, s.trace.line_width);
            }
        }
    }
    stroke::practise(drawn, tables);
    for (stroke::Stroke& s : strokes) s.trace.line_width = 0;
    if (!missed) return;
    const stroke::LineWidths& widths = tables.of(missed->trace.brush);
    const std::string asked = most > least ? fmt::format("{:.3g} to {:.3g}", least / kMillimetre, most / kMillimetre) : fmt::format("{:.3g}", most / kMillimetre);
    console.note(fmt::format("the drawing has lines {} mm wide; {} draws {:.2g} to {:.2g} mm (without --brush it is made to fit)", asked, missed->trace.brush,
                             widths.least() / kMillimetre, widths.most() / kMillimetre));
}

constexpr double kTooLarge = 3;  // diagonals of the model

double extent_along(const Box& box, const Vec3& direction) {
    return glm::dot(box.size(), glm::abs(direction));
}

void lay_drawing(std::vector<stroke::Stroke>& strokes, const stroke::Model& model, const Paint& a, stroke::WidthTables& widths, Console& console) {
    std::vector<stroke::Trace*> drawing;
    Box area;
    for (stroke::Stroke& s : strokes) {
        if (s.layer == stroke::kPaletteLayer) continue;  // in its own frame
        if (!s.trace.placed) s.trace.placement.laying = stroke::Laying::drape;
        if (const auto laying = stroke::laying_named(a.laying)) s.trace.placement.laying = *laying;
        if (!s.trace.flat || (a.place_mm.empty() && s.trace.placed)) continue;
        drawing.push_back(&s.trace);
        stroke::add_extent(area, s.trace);
    }
    if (area.empty()) return;
    const Box& box = model.mesh->bounds;
    // What lies flat, such as a sheet or a plate, is written on from above.
    const bool lies = box.size().z < 0.25 * std::min(box.size().x, box.size().y);
    const Vec3 look = lies ? Vec3{0, 0, -1} : Vec3{0, 1, 0}, before = box.centre() - box.diagonal() * look;
    const double turn = a.place_turn_deg * kDegree, width = std::max(area.size().x, 0.05 * area.size().y);
    double scale = a.place_width_mm > 0 && width > 0 ? a.place_width_mm * kMillimetre / width : 1;
    std::optional<mesh::SurfacePoint> at;
    Vec3 normal;
    std::string note;
    if (a.place_mm.empty()) {
        const Vec2 size = std::abs(std::cos(turn)) * Vec2(area.size()) + std::abs(std::sin(turn)) * Vec2(area.size().y, area.size().x);
        const auto [right, down] = upright(-look, 0);
        const double fill = std::max(size.x / extent_along(box, right), size.y / extent_along(box, down));
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
        at = model.query->closest_point(kMillimetre * Vec3(a.place_mm[0], a.place_mm[1], a.place_mm[2]));
        normal = at->normal;
    }
    const auto [right, down] = upright(normal, turn);
    if (a.place_mm.empty())
        console.note(fmt::format("the strokes name no place; they go to the {} of the model, at {:.1f},{:.1f},{:.1f} mm (see --place){}",
                                 lies ? "top" : "front", at->position.x / kMillimetre, at->position.y / kMillimetre, at->position.z / kMillimetre, note));
    if (const double large = scale * std::max(area.size().x, area.size().y); large > kTooLarge * box.diagonal())
        console.note(fmt::format("the drawing is {:.4g} mm large, the model {:.4g} mm: most of it meets no surface (see --place-width, --unit)",
                                 large / kMillimetre, box.diagonal() / kMillimetre));
    for (stroke::Trace* trace : drawing) trace->line_width *= scale;
    if (a.brush.empty()) size_brushes(strokes, drawing, scale, scale * std::max(area.size().x, area.size().y), widths);
    for (stroke::Trace* trace : drawing) {
        for (stroke::TraceSample& sample : trace->samples) {
            sample.position = scale * (sample.position - area.centre());
            sample.time *= scale;
        }
        for (stroke::TapeEdge& edge : trace->tape)
            for (Vec2* end : {&edge.from, &edge.to}) *end = scale * (*end - Vec2(area.centre()));
        trace->placement.origin = at->position;
        trace->placement.right = right;
        trace->placement.down = down;
        trace->placed = true;
    }
}

}  // namespace

void place_strokes(std::vector<stroke::Stroke>& strokes, const stroke::Model& model, const Paint& a,
                   Console& console) {
    stroke::WidthTables widths;
    lay_drawing(strokes, model, a, widths, console);
    for (stroke::Stroke& s : strokes)
        if (s.trace.brush.empty() && stroke::has_brush(s.action)) s.trace.brush = kBrush;
    press_to_widths(strokes, widths, console);
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
