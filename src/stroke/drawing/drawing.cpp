#include "stroke/drawing/drawing.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

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
bool has_width(const PaintStroke& s) {
    return s.trace.flat && !s.trace.pressed && s.trace.line_width > 0 && s.settings.pressure == PressureFrom::none;
}

/// Films of full brushes of inks, each looked up once: to read an ink takes as long as to paint a short line.
class Films {
  public:
    explicit Films(const BrushFit& fit) : fit_(fit) {}

    /// Metres.
    double of(const std::string& ink) {
        const auto [at, is_new] = films_.try_emplace(ink, 0.0);
        if (is_new) at->second = find(ink);
        return at->second;
    }

  private:
    double find(const std::string& ink) const {
        if (fit_.film) return fit_.film(ink);
        try {
            return ink::load_ink(ink).film * ink::kFilmUnit;
        } catch (const Error&) {
            return ink::Ink{}.film * ink::kFilmUnit;  // of a project
        }
    }

    const BrushFit& fit_;
    std::unordered_map<std::string, double> films_;
};

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

void transform_samples(StrokeSamples& trace, const Vec2& centre, double scale, bool mirrored) {
    for (StrokeSample& sample : trace.samples) {
        sample.position = scale * (sample.position - Vec3(centre, 0));
        sample.time *= scale;
    }
    for (StencilEdge& edge : trace.stencil)
        for (Vec2* end : {&edge.from, &edge.to}) *end = scale * (*end - centre);
    for (auto& ring : trace.outline)
        for (Vec2& p : ring) p = scale * (p - centre);
    trace.line_width *= scale;
    if (!mirrored) return;
    for (auto& ring : trace.outline)
        for (Vec2& p : ring) p.x *= -1;
    for (StrokeSample& sample : trace.samples) sample.position.x *= -1, sample.tilt.x *= -1, sample.roll *= -1;
    for (StencilEdge& edge : trace.stencil) edge = {Vec2(-edge.to.x, edge.to.y), Vec2(-edge.from.x, edge.from.y)};
}

Box extent_of(std::span<StrokeSamples* const> drawing) {
    Box box;
    for (const StrokeSamples* trace : drawing) add_extent(box, *trace);
    return box;
}

double width_of(const Box& extent) {
    return std::max(extent.size().x, 0.05 * extent.size().y);
}

void arrange_parts(std::span<StrokeSamples* const> drawing) {
    double edge = 0;
    for (std::size_t i = 0; i < drawing.size();) {
        std::size_t end = i;
        while (end < drawing.size() && same_place(drawing[end]->placement, drawing[i]->placement)) ++end;
        const std::span<StrokeSamples* const> part = drawing.subspan(i, end - i);
        const Box box = extent_of(part);
        const double shift = i == 0 ? 0 : edge - box.lo.x + kPartGap * std::max(box.size().x, box.size().y);
        if (shift != 0)
            for (StrokeSamples* trace : part) transform_samples(*trace, {-shift, 0}, 1);
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

std::vector<StrokeSamples*> drawing_in(std::vector<JournalEntry>& entries, bool all) {
    std::vector<StrokeSamples*> drawing;
    for (JournalEntry& entry : entries) {
        PaintStroke* s = entry.as<PaintStroke>();
        if (s && s->layer != kPaletteLayer && s->trace.flat && (all || !s->trace.placed)) drawing.push_back(&s->trace);
    }
    return drawing;
}

std::vector<FlatArea*> areas_in(std::vector<JournalEntry>& entries, bool all) {
    std::vector<FlatArea*> areas;
    for (JournalEntry& entry : entries) {
        Fill* fill = entry.as<Fill>();
        if (fill && fill->area && (all || !fill->area->placed)) areas.push_back(&*fill->area);
    }
    return areas;
}

void add_extent(Box& box, const FlatArea& area) {
    box.add(Vec3(area.low, 0));
    box.add(Vec3(area.high, 0));
}

// `shape`: an area or samples. Their way of mapping stays.
void put_at(auto& shape, const Placement& place) {
    shape.placement.origin = place.origin;
    shape.placement.right = place.right;
    shape.placement.down = place.down;
    shape.placed = true;
}

void place_areas(std::span<FlatArea* const> areas, const DrawingPlace& place) {
    for (FlatArea* area : areas) {
        transform_area(*area, place.centre, place.scale, place.mirrored);
        put_at(*area, place.placement);
    }
}

void place_drawing(std::span<StrokeSamples* const> drawing, const DrawingPlace& place) {
    for (StrokeSamples* trace : drawing) {
        transform_samples(*trace, place.centre, place.scale, place.mirrored);
        put_at(*trace, place.placement);
    }
}

namespace {

/// The brush that a stroke is painted with, in the size that fits it. `placed`: the drawing that it is part of; or
/// null.
std::string sized_brush(const PaintStroke& s, const PlacedTraces* placed, const BrushFit& fit, WidthTables& widths,
                        Films& films) {
    std::string sized = s.brush;
    if (sized.empty() && !fit.otherwise.empty())
        sized = fit.otherwise;
    else if (sized.empty() && placed)
        sized = brush::name_of({kDefaultBrush, std::min(1.0, placed->extent / kWriting)});
    else if (sized.empty())
        sized = kDefaultBrush;
    else if (fit.grow && placed) {
        const brush::SizedName name = brush::sized_name(sized);
        sized = brush::name_of({name.base, name.factor * placed->scale});
    }
    if (!fit.fit || !has_width(s)) return sized;
    // The line says how large the brush is, not the size that the brush was in.
    const std::vector<StrokeSample>& samples = s.trace.samples;
    const double length = length_of(s.trace),
                 speed = length / std::max(samples.back().time - samples.front().time, 1e-9);
    return brush_for_line(brush::sized_name(sized).base, widths, s.trace.line_width, s.settings.endless ? 0 : length,
                          films.of(s.ink), speed);
}

}  // namespace

void fill_wide_lines(std::vector<JournalEntry>& entries, double wide, AreaEdges edges) {
    struct Drawing {
        Placement placement;
        Vec2 low{HUGE_VAL}, high{-HUGE_VAL};
    };
    std::vector<Drawing> drawings;
    std::vector<std::pair<FlatArea*, std::size_t>> areas;  // and the drawing that each is part of
    for (JournalEntry& entry : entries) {
        PaintStroke* s = entry.as<PaintStroke>();
        if (!s) continue;
        std::vector<std::vector<Vec2>> rings = std::exchange(s->trace.outline, {});
        if (rings.empty() || s->trace.line_width < wide || s->erases() || s->settings.film != FilmModel::still)
            continue;
        const Placement placement = s->trace.placement;
        auto at =
            std::find_if(drawings.begin(), drawings.end(), [&](const Drawing& d) { return d.placement == placement; });
        if (at == drawings.end()) at = drawings.insert(at, {.placement = placement});
        for (const auto& ring : rings)
            for (const Vec2& p : ring) at->low = glm::min(at->low, p), at->high = glm::max(at->high, p);
        std::vector<Vec2> line;
        for (const StrokeSample& p : s->trace.samples) line.emplace_back(p.position);
        FlatArea area{.rings = std::move(rings),
                      .lines = {std::move(line)},
                      .placement = placement,
                      .placed = true,
                      .edges = edges,
                      .stops = {{.ink = s->ink}}};
        Fill fill = fill_of_area(std::move(area));
        fill.layer = s->layer, fill.mask = s->mask, fill.names = s->names;
        entry.content = std::move(fill);
        areas.emplace_back(&*entry.get<Fill>().area, static_cast<std::size_t>(at - drawings.begin()));
    }
    for (const auto& [area, k] : areas) area->low = drawings[k].low, area->high = drawings[k].high;
}

void choose_brushes(std::vector<JournalEntry>& entries, const PlacedTraces& drawing, const BrushFit& fit,
                    WidthTables& widths) {
    // What is done with a brush before a stroke is done with the brush of that stroke.
    const std::unordered_set<const StrokeSamples*> among(drawing.traces.begin(), drawing.traces.end());
    Films films(fit);
    std::string own, sized;
    for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
        PaintStroke* s = entry->as<PaintStroke>();
        if (s && s->layer != kPaletteLayer) {
            own = s->brush;
            s->brush = sized = sized_brush(*s, among.contains(&s->trace) ? &drawing : nullptr, fit, widths, films);
        } else if (brush_of(*entry) == own) {
            set_brush(*entry, sized);
        }
    }
    for (JournalEntry& entry : entries)
        if (has_brush(kind_of(entry)) && brush_of(entry).empty())
            set_brush(entry, fit.otherwise.empty() ? kDefaultBrush : fit.otherwise);
}

void redip_long_lines(std::vector<JournalEntry>& entries, const BrushFit& fit, WidthTables& widths) {
    constexpr double kMargin = 1.1;  // of both ends that lie over each other
    std::vector<JournalEntry> out;
    out.reserve(entries.size());
    Films films(fit);
    for (JournalEntry& entry : entries) {
        PaintStroke* s = entry.as<PaintStroke>();
        if (!s || !has_width(*s) || s->settings.dip != DipMode::each || s->settings.endless || s->erases()) {
            out.push_back(std::move(entry));
            continue;
        }
        const double width = s->trace.line_width, film = films.of(s->ink);
        pace_line(s->trace, widths.preset(s->brush), film);
        const double longest = whole_length(widths.preset(s->brush), width, film);
        for (StrokeSamples& piece : cut_line(s->trace, longest, kMargin * 2 * line_end(width))) {
            out.push_back(entry);
            out.back().as<PaintStroke>()->trace = std::move(piece);
        }
    }
    entries = std::move(out);
}

WidthMismatch press_to_widths(std::vector<JournalEntry>& entries, WidthTables& tables) {
    WidthMismatch mismatch;
    std::vector<PaintStroke*> drawn;
    for (JournalEntry& entry : entries) {
        PaintStroke* s = entry.as<PaintStroke>();
        if (!s || !has_width(*s)) continue;
        const double width = s->trace.line_width;
        const LineWidths& widths = tables.of(s->brush);
        draw_to_width(s->trace, widths);
        drawn.push_back(s);
        if (width >= widths.least() && width <= widths.most()) continue;
        if (s->brush != mismatch.brush) mismatch = {.brush = s->brush, .least = width, .most = width};
        mismatch = {s->brush, std::min(mismatch.least, width), std::max(mismatch.most, width), widths.least(),
                    widths.most()};
    }
    fit_trajectory(drawn, tables);
    for (JournalEntry& entry : entries)
        if (PaintStroke* s = entry.as<PaintStroke>()) s->trace.line_width = 0;
    return mismatch;
}

}  // namespace tuft::stroke
