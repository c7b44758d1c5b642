#include "stroke/drawing/drawing.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "core/error.h"
#include "ink/colour/pigments.h"
#include "stroke/drawing/fit_trajectory.h"
#include "stroke/drawing/long_lines.h"

namespace tuft::stroke {
namespace {

// Surfaces with more of the normal along z are read from above, not from where they face.
constexpr double kLies = 0.8;
constexpr double kWriting = 0.06;  // metres of drawing that kDefaultBrush suits
constexpr double kPartGap = 0.15;  // of a part's larger side

bool same_place(const Placement& a, const Placement& b) {
    return a.origin == b.origin && a.right == b.right && a.down == b.down;
}

/// Whether the hand presses as the drawing's line widths say.
bool has_width(const Stroke& s) {
    return s.action == Action::stroke && s.trace.flat && !s.trace.pressed && s.trace.line_width > 0 &&
           s.settings.pressure == "none";
}

double film_of(const BrushFit& fit, const std::string& ink) {
    if (fit.film) return fit.film(ink);
    try {
        return ink::load_ink(ink).film * ink::kFilmUnit;
    } catch (const Error&) {
        return ink::Ink{}.film * ink::kFilmUnit;  // of a project
    }
}

Placement turned(const Vec3& origin, const Vec3& normal, const Vec3& right, double turn) {
    const Vec3 down = glm::cross(right, normal);
    return {.origin = origin,
            .right = std::cos(turn) * right - std::sin(turn) * down,
            .down = std::cos(turn) * down + std::sin(turn) * right,
            .mapping = SurfaceMapping::drape};
}

}  // namespace

Vec3 upright_right(const Vec3& n) {
    return std::abs(n.z) < kLies ? glm::normalize(glm::cross(Vec3{0, 0, 1}, n)) : make_frame(Vec3{0}, n).t;
}

void transform_trace(Trace& trace, const Vec2& centre, double scale, bool mirrored) {
    for (TraceSample& sample : trace.samples) {
        sample.position = scale * (sample.position - Vec3(centre, 0));
        sample.time *= scale;
    }
    for (StencilEdge& edge : trace.stencil)
        for (Vec2* end : {&edge.from, &edge.to}) *end = scale * (*end - centre);
    trace.line_width *= scale;
    if (!mirrored) return;
    for (TraceSample& sample : trace.samples) sample.position.x *= -1, sample.tilt.x *= -1;
    for (StencilEdge& edge : trace.stencil) edge = {Vec2(-edge.to.x, edge.to.y), Vec2(-edge.from.x, edge.from.y)};
}

Box extent_of(std::span<Trace* const> drawing) {
    Box box;
    for (const Trace* trace : drawing) add_extent(box, *trace);
    return box;
}

double width_of(const Box& extent) {
    return std::max(extent.size().x, 0.05 * extent.size().y);
}

void arrange_parts(std::span<Trace* const> drawing) {
    double edge = 0;
    for (std::size_t i = 0; i < drawing.size();) {
        std::size_t end = i;
        while (end < drawing.size() && same_place(drawing[end]->placement, drawing[i]->placement)) ++end;
        const std::span<Trace* const> part = drawing.subspan(i, end - i);
        const Box box = extent_of(part);
        const double shift = i == 0 ? 0 : edge - box.lo.x + kPartGap * std::max(box.size().x, box.size().y);
        if (shift != 0)
            for (Trace* trace : part) transform_trace(*trace, {-shift, 0}, 1);
        edge = box.hi.x + shift;
        i = end;
    }
}

Placement upright_placement(const Vec3& origin, const Vec3& normal, double turn) {
    return turned(origin, normal, upright_right(normal), turn);
}

Placement placement_seen(const Vec3& origin, const Vec3& normal, const Vec3& right, double turn) {
    const Vec3 along = right - glm::dot(right, normal) * normal;
    if (!(glm::length(along) > 1e-6 * glm::length(right))) return upright_placement(origin, normal, turn);
    return turned(origin, normal, glm::normalize(along), turn);
}

Vec3 reading_right(const Vec3& from) {
    const Vec3 right = glm::cross(Vec3{0, 0, 1}, from);
    return glm::length(right) > 1e-6 * glm::length(from) ? glm::normalize(right) : Vec3{1, 0, 0};
}

double turn_of(const Vec3& normal, const Vec3& upright, const Vec3& right) {
    const Vec3 down = glm::cross(upright, normal);
    return std::atan2(-glm::dot(right, down), glm::dot(right, upright));
}

std::vector<Trace*> drawing_in(std::vector<Stroke>& entries, bool all) {
    std::vector<Trace*> drawing;
    for (Stroke& s : entries)
        if (s.layer != kPaletteLayer && s.trace.flat && (all || !s.trace.placed)) drawing.push_back(&s.trace);
    return drawing;
}

void place_drawing(std::span<Trace* const> drawing, const DrawingPlace& place) {
    for (Trace* trace : drawing) {
        transform_trace(*trace, place.centre, place.scale, place.mirrored);
        trace->placement.origin = place.placement.origin;
        trace->placement.right = place.placement.right;
        trace->placement.down = place.placement.down;
        trace->placed = true;
    }
}

void choose_brushes(std::vector<Stroke>& entries, std::span<Trace* const> drawing, double scale, double extent,
                    const BrushFit& fit, WidthTables& widths) {
    // What is done with a brush before a stroke is done with the brush of that stroke.
    const std::unordered_set<const Trace*> among(drawing.begin(), drawing.end());
    std::string own, sized;
    for (auto s = entries.rbegin(); s != entries.rend(); ++s) {
        Trace& trace = s->trace;
        if (s->action == Action::stroke && s->layer != kPaletteLayer) {
            own = sized = trace.brush;
            const bool placed = among.contains(&trace);
            if (own.empty() && !fit.otherwise.empty())
                sized = fit.otherwise;
            else if (own.empty() && placed)
                sized = brush::name_of({kDefaultBrush, std::min(1.0, extent / kWriting)});
            else if (own.empty())
                sized = kDefaultBrush;
            else if (fit.grow && placed) {
                const brush::SizedName name = brush::sized_name(own);
                sized = brush::name_of({name.base, name.factor * scale});
            }
            if (fit.fit && has_width(*s)) {
                // The line says how large the brush is, not the size that the brush was in.
                const std::string base = brush::sized_name(sized).base;
                const double length = length_of(trace),
                             speed = length / std::max(trace.samples.back().time - trace.samples.front().time, 1e-9);
                sized = brush_for_line(base, widths, trace.line_width, s->settings.endless ? 0 : length,
                                       film_of(fit, trace.ink), speed);
            }
            trace.brush = sized;
        } else if (trace.brush == own) {
            trace.brush = sized;
        }
    }
    for (Stroke& s : entries)
        if (s.trace.brush.empty() && has_brush(s.action))
            s.trace.brush = fit.otherwise.empty() ? kDefaultBrush : fit.otherwise;
}

void redip_long_lines(std::vector<Stroke>& entries, const BrushFit& fit, WidthTables& widths) {
    constexpr double kMargin = 1.1;  // of both ends that lie over each other
    std::vector<Stroke> out;
    out.reserve(entries.size());
    for (Stroke& s : entries) {
        if (!has_width(s) || s.settings.dip != "each" || s.settings.endless || s.trace.erases) {
            out.push_back(std::move(s));
            continue;
        }
        const double width = s.trace.line_width, film = film_of(fit, s.trace.ink);
        pace_line(s.trace, widths.preset(s.trace.brush), film);
        const double longest = whole_length(widths.preset(s.trace.brush), width, film);
        Stroke piece = s;
        for (Trace& trace : cut_line(s.trace, longest, kMargin * 2 * line_end(width))) {
            piece.trace = std::move(trace);
            out.push_back(piece);
        }
    }
    entries = std::move(out);
}

WidthMismatch press_to_widths(std::vector<Stroke>& entries, WidthTables& tables) {
    WidthMismatch mismatch{.least = 1e30};
    std::vector<Trace*> drawn;
    for (Stroke& s : entries) {
        if (!has_width(s)) continue;
        const double width = s.trace.line_width;
        const LineWidths& widths = tables.of(s.trace.brush);
        draw_to_width(s.trace, widths);
        drawn.push_back(&s.trace);
        if (width >= widths.least() && width <= widths.most()) continue;
        mismatch = {s.trace.brush, std::min(mismatch.least, width), std::max(mismatch.most, width), widths.least(),
                    widths.most()};
    }
    fit_trajectory(drawn, tables);
    for (Stroke& s : entries) s.trace.line_width = 0;
    return mismatch;
}

}  // namespace tuft::stroke
