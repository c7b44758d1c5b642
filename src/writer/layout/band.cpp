#include "writer/layout/band.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "stroke/drawing/bend.h"
#include "stroke/drawing/drawing.h"

namespace tuft::writer {
namespace {

constexpr double kMeets = 0.01;  // of a path's length, between ends that meet

/// Geodesic curvature of a path at a length on it, 1/m, positive to the left: dT/ds · (n × T).
double curvature_of(const ModelPath& path, double along, double reach) {
    const PathPlace at = place_on(path, along, reach);
    const Vec3 before = place_on(path, along - reach, reach).right, after = place_on(path, along + reach, reach).right;
    return glm::dot(after - before, glm::cross(at.normal, at.right)) / (2 * reach);
}

/// Puts one copy at its place.
void place_copy(std::vector<stroke::JournalEntry>& copy, const BandPlace& at, const Vec2& centre, const Band& band,
                bool all) {
    const stroke::DrawingPlace place{at.placement, centre, band.scale, band.mirrored};
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(copy, all);
    const std::vector<stroke::FlatArea*> areas = stroke::areas_in(copy, all);
    stroke::place_drawing(drawing, place);
    stroke::place_areas(areas, place);
    Box bounds;
    for (stroke::StrokeSamples* trace : drawing) {
        stroke::lap_ends(trace->outline, 0.5 * band.width, band.lap);
        stroke::bend_samples(*trace, at.curvature, band.width);
    }
    for (stroke::FlatArea* area : areas) {
        stroke::lap_ends(area->rings, 0.5 * band.width, band.lap);
        stroke::bend_area(*area, at.curvature, band.width);
        stroke::add_extent(bounds, *area);
    }
    for (stroke::FlatArea* area : areas) area->low = Vec2(bounds.lo), area->high = Vec2(bounds.hi);
}

}  // namespace

void close_where_ends_meet(ModelPath& path) {
    if (path.closed || path.points.size() < 3) return;
    if (glm::distance(path.points.front(), path.points.back()) >= kMeets * path.length()) return;
    path.points.pop_back(), path.normals.pop_back();
    path.closed = true;
}

Band band_of(double length, const Box& extent, const BandOptions& options) {
    const double width = extent.empty() ? 0 : stroke::width_of(extent);
    if (!(length > 0) || !(width > 0)) throw Error(Message("a band needs a path and a drawing with a length"));
    const double wanted = options.width > 0 ? options.width : width;
    Band band{.repeats = options.repeats, .scale = wanted / width, .mirrored = options.mirrored};
    const bool fit = band.repeats <= 0;
    if (fit) band.repeats = static_cast<int>(std::clamp(std::round(length / wanted), 1.0, double(kMostCopies)));
    band.step = length / band.repeats;
    if (fit || options.width <= 0) band.scale = band.step / width;
    band.width = band.scale * width;
    band.height = band.scale * extent.size().y;
    if (band.width > (1 - 1e-6) * band.step) band.lap = options.texel;
    return band;
}

std::vector<BandPlace> band_places(const ModelPath& path, const Band& band) {
    std::vector<BandPlace> places;
    for (int k = 0; k < band.repeats; ++k) {
        const double along = (k + (path.closed ? 0 : 0.5)) * band.step, reach = kBandReach * band.step;
        const PathPlace at = place_on(path, along, reach);
        places.push_back({{.origin = at.position,
                           .right = at.right,
                           .down = glm::cross(at.right, at.normal),
                           .mapping = stroke::SurfaceMapping::drape},
                          curvature_of(path, along, reach)});
    }
    return places;
}

std::vector<Vec2> line_in_band(const std::vector<Vec2>& line, const Vec2& centre, const Band& band, double curvature) {
    std::vector<Vec2> out;
    out.reserve(line.size());
    for (const Vec2& drawn : line) {
        const Vec2 p = band.scale * (drawn - centre);
        out.push_back(stroke::bend_point({band.mirrored ? -p.x : p.x, p.y}, curvature));
    }
    return out;
}

std::vector<stroke::JournalEntry> repeat_along(const std::vector<stroke::JournalEntry>& entries,
                                               const std::vector<BandPlace>& places, const Vec2& centre,
                                               const Band& band, bool all) {
    std::vector<stroke::JournalEntry> out;
    for (const BandPlace& at : places) {
        std::vector<stroke::JournalEntry> copy = entries;
        place_copy(copy, at, centre, band, all);
        out.insert(out.end(), std::make_move_iterator(copy.begin()), std::make_move_iterator(copy.end()));
    }
    return out;
}

}  // namespace tuft::writer
