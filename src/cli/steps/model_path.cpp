#include "cli/steps/model_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/text/units.h"
#include "stroke/drawing/bend.h"
#include "stroke/drawing/drawing.h"
#include "stroke/placement/placement.h"
#include "writer/layout/feature_line.h"

namespace tuft::cli {
namespace {

constexpr double kRimHeight = 0.62;  // of the model's height, where no place is named
constexpr double kMeets = 0.01;      // of a line's length, between ends that meet
constexpr int kMostRepeats = 1000;
constexpr double kEdgeReach = 0.05, kEdgeReachOfModel = 0.1;  // metres; of the model's diagonal: the less of both
constexpr double kReach = 0.25;  // of a step, to either side, over which the path's direction is taken

std::string name_of(const writer::FeatureLine& line) {
    const double degrees = line.angle / kDegree;
    switch (line.kind) {
        case writer::LineKind::border:
            return "a border of the surface";
        case writer::LineKind::sharp_edge:
            return fmt::format("an edge of {:.0f} degrees", degrees);
        case writer::LineKind::group_border:
            return "a border between groups";
        case writer::LineKind::crease:
            break;
    }
    return fmt::format("a crease of {:.0f} degrees within {:.0f} mm", degrees, line.over / kMillimetre);
}

/// How a drawing is repeated.
struct Band {
    int repeats = 1;
    double step = 0, scale = 1, width = 0;  ///< metres between middles; factor; metres, as painted
    double lap = 0;                         ///< metres, of neighbours that meet
};

Band band_of(double length, double width, const Paint& a) {
    const double wanted = a.place.width_mm > 0 ? a.place.width_mm * kMillimetre : width;
    Band band{.repeats = repeats_of(a.copies.repeat), .scale = wanted / width};
    const bool fit = band.repeats == 0;
    if (fit) band.repeats = static_cast<int>(std::clamp(std::round(length / wanted), 1.0, double(kMostRepeats)));
    band.step = length / band.repeats;
    if (fit || a.place.width_mm <= 0) band.scale = band.step / width;
    band.width = band.scale * width;
    return band;
}

/// Geodesic curvature of a path at a length on it, 1/m, positive to the left: dT/ds · (n × T).
double curvature_of(const writer::ModelPath& path, double along, double reach) {
    const writer::PathPlace at = writer::place_on(path, along, reach);
    const Vec3 before = writer::place_on(path, along - reach, reach).right,
               after = writer::place_on(path, along + reach, reach).right;
    return glm::dot(after - before, glm::cross(at.normal, at.right)) / (2 * reach);
}

/// Puts a copy of the drawing at one place of the path.
void place_copy(std::vector<stroke::JournalEntry>& copy, const Band& band, const Vec2& centre,
                const writer::PathPlace& at, double curvature, const Paint& a) {
    const stroke::DrawingPlace place{
        {.origin = at.position, .right = at.right, .down = glm::cross(at.right, at.normal)},
        centre,
        band.scale,
        a.place.mirror};
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(copy, false);
    const std::vector<stroke::FlatArea*> areas = stroke::areas_in(copy, false);
    stroke::place_drawing(drawing, place);
    stroke::place_areas(areas, place);
    Box bounds;
    for (stroke::StrokeSamples* trace : drawing) {
        stroke::lap_ends(trace->outline, 0.5 * band.width, band.lap);
        stroke::bend_samples(*trace, curvature, band.width);
    }
    for (stroke::FlatArea* area : areas) {
        stroke::lap_ends(area->rings, 0.5 * band.width, band.lap);
        stroke::bend_area(*area, curvature, band.width);
        stroke::add_extent(bounds, *area);
    }
    for (stroke::FlatArea* area : areas) area->low = Vec2(bounds.lo), area->high = Vec2(bounds.hi);
}

}  // namespace

PathOnModel rim_path(const stroke::Model& model, const Paint& a) {
    const Box& box = model.mesh->bounds;
    Vec3 through = box.centre();
    if (!a.place.at_mm.empty()) {
        through = model.query->closest_point(kMillimetre * vector_of(a.place.at_mm))->position;
    } else {
        through.z = box.lo.z + kRimHeight * box.size().z;
        const Vec3 before(through.x, box.lo.y - box.diagonal(), through.z);
        if (const auto front = model.query->ray(before, {0, 1, 0})) through = front->position;
    }
    return {writer::level_section(*model.query, through), 0};
}

PathOnModel edge_path(const stroke::Model& model, const Paint& a, Console& console) {
    if (a.place.at_mm.empty()) throw UsageError("--along edge needs a point near the edge (see --place)");
    const double reach = std::min(kEdgeReach, kEdgeReachOfModel * model.mesh->bounds.diagonal());
    writer::FeatureLine line = writer::feature_line(*model.query, kMillimetre * vector_of(a.place.at_mm), reach);
    console.note(fmt::format("the line is {}, {:.3g} mm from the place, {:.4g} mm long{}", name_of(line),
                             line.away / kMillimetre, line.path.length() / kMillimetre,
                             line.path.closed ? ", closed" : ""));
    return {std::move(line.path), 0};
}

PathOnModel curve_path(const stroke::Model& model, const Paint& a, const std::filesystem::path& file,
                       Console& console) {
    Paint line = a;
    line.strokes = {file};
    line.copies.along.clear();
    line.drawing.wide_lines_mm = 1e9;  // a line, not what it covers
    std::vector<stroke::JournalEntry> entries = load_strokes(line, console);
    place_strokes(entries, model, line, console);
    for (const stroke::JournalEntry& entry : entries)
        if (const stroke::StrokeSamples& trace = stroke::samples_of(entry); trace.flat && trace.samples.size() > 1) {
            PathOnModel out;
            for (const stroke::SurfaceSample& s : stroke::map_to_surface(*model.query, trace).samples) {
                out.path.points.push_back(s.position);
                out.path.normals.push_back(s.normal);
            }
            const double length = out.path.length();
            if (out.path.points.size() > 2 &&
                glm::distance(out.path.points.front(), out.path.points.back()) < kMeets * length) {
                out.path.points.pop_back(), out.path.normals.pop_back();
                out.path.closed = true;
            }
            out.middle = 0.5 * out.path.length();
            return out;
        }
    throw Error(file.string(), Message("it has no flat line"));
}

int repeats_of(const std::string& text) {
    if (text == "fit") return 0;
    int n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (fault != std::errc{} || end != text.data() + text.size() || n < 1 || n > kMostRepeats)
        throw UsageError("--repeat is 'fit' or a number from 1 to 1000, not '" + excerpt(text) + "'");
    return n;
}

PlacedDrawing place_along(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, const Paint& a,
                          Console& console) {
    repeats_of(a.copies.repeat);
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(strokes, false);
    const std::vector<stroke::FlatArea*> areas = stroke::areas_in(strokes, false);
    stroke::arrange_parts(drawing);
    Box extent = stroke::extent_of(drawing);
    for (const stroke::FlatArea* area : areas) stroke::add_extent(extent, *area);
    if (drawing.empty() && areas.empty()) throw UsageError("--along repeats a flat drawing without a place of its own");
    const PathOnModel on = a.copies.along == "rim"    ? rim_path(model, a)
                           : a.copies.along == "edge" ? edge_path(model, a, console)
                                                      : curve_path(model, a, a.copies.along, console);
    const double length = on.path.length(), width = stroke::width_of(extent);
    if (!(length > 0) || !(width > 0)) throw UsageError("--along needs a path and a drawing with a length");
    Band band = band_of(length, width, a);
    if (band.width > (1 - 1e-6) * band.step) band.lap = model.texels.texel_size;
    std::vector<stroke::JournalEntry> all;
    for (int k = 0; k < band.repeats; ++k) {
        const double along = (k + (on.path.closed ? 0 : 0.5)) * band.step, reach = kReach * band.step;
        std::vector<stroke::JournalEntry> copy = strokes;
        place_copy(copy, band, Vec2(extent.centre()), writer::place_on(on.path, along, reach),
                   curvature_of(on.path, along, reach), a);
        all.insert(all.end(), std::make_move_iterator(copy.begin()), std::make_move_iterator(copy.end()));
    }
    strokes = std::move(all);
    console.note(fmt::format("{} cop{} along {:.4g} mm, one every {:.4g} mm, {:.4g} mm wide (written {:.4g} mm)",
                             band.repeats, band.repeats == 1 ? "y" : "ies", length / kMillimetre,
                             band.step / kMillimetre, band.width / kMillimetre, width / kMillimetre));
    Paint placed = a;  // every copy has its place
    placed.copies.along.clear(), placed.place.at_mm.clear(), placed.place.on.clear();
    placed.place.width_mm = 0, placed.place.mirror = false;
    place_strokes(strokes, model, placed, console);
    const writer::PathPlace first = writer::place_on(on.path, 0, kReach * band.step);
    return {.at = first.position,
            .normal = first.normal,
            .size = band.scale * Vec2(extent.size()),
            .repeats = band.repeats,
            .step = band.step,
            .path = length};
}

}  // namespace tuft::cli
