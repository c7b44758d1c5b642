#include "cli/steps/model_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"
#include "stroke/placement/placement.h"
#include "writer/layout/band.h"
#include "writer/layout/feature_line.h"

namespace tuft::cli {
namespace {

constexpr double kRimHeight = 0.62;  // of the model's height, where no place is named

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
    writer::FeatureLine line = writer::feature_line(*model.query, kMillimetre * vector_of(a.place.at_mm),
                                                    writer::feature_reach(model.mesh->bounds));
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
            writer::close_where_ends_meet(out.path);
            out.middle = 0.5 * out.path.length();
            return out;
        }
    throw Error(file.string(), Message("it has no flat line"));
}

int repeats_of(const std::string& text) {
    if (text == "fit") return 0;
    int n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (fault != std::errc{} || end != text.data() + text.size() || n < 1 || n > writer::kMostCopies)
        throw UsageError("--repeat is 'fit' or a number from 1 to 1000, not '" + excerpt(text) + "'");
    return n;
}

namespace {

/// Indices of the entries whose traces are these.
std::vector<std::size_t> indices_of(const std::vector<stroke::JournalEntry>& entries,
                                    const std::vector<stroke::StrokeSamples*>& drawing) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (std::ranges::find(drawing, &stroke::samples_of(entries[i])) != drawing.end()) found.push_back(i);
    return found;
}

PathOnModel path_of(const stroke::Model& model, const Paint& a, Console& console) {
    if (a.copies.along == "rim") return rim_path(model, a);
    if (a.copies.along == "edge") return edge_path(model, a, console);
    return curve_path(model, a, a.copies.along, console);
}

}  // namespace

PlacedDrawing place_along(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, const Paint& a,
                          Console& console) {
    const bool all = !a.place.at_mm.empty();
    const writer::BandOptions options{.repeats = repeats_of(a.copies.repeat),
                                      .width = a.place.width_mm * kMillimetre,
                                      .mirrored = a.place.mirror,
                                      .texel = model.texels.texel_size};
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(strokes, all);
    const std::vector<stroke::FlatArea*> areas = stroke::areas_in(strokes, all);
    if (drawing.empty() && areas.empty()) throw UsageError("--along repeats a flat drawing without a place of its own");
    set_mappings(strokes, a);
    stroke::arrange_parts(drawing);
    Box extent = stroke::extent_of(drawing);
    for (const stroke::FlatArea* area : areas) stroke::add_extent(extent, *area);
    const PathOnModel on = path_of(model, a, console);
    const double length = on.path.length(), width = stroke::width_of(extent);
    if (!(length > 0) || !(width > 0)) throw UsageError("--along needs a path and a drawing with a length");
    const writer::Band band = writer::band_of(length, extent, options);
    const std::vector<std::size_t> drawn = indices_of(strokes, drawing);
    const std::size_t n = strokes.size();
    strokes = writer::repeat_along(strokes, writer::band_places(on.path, band), Vec2(extent.centre()), band, all);
    console.note(fmt::format("{} cop{} along {:.4g} mm, one every {:.4g} mm, {:.4g} mm wide (written {:.4g} mm)",
                             band.repeats, band.repeats == 1 ? "y" : "ies", length / kMillimetre,
                             band.step / kMillimetre, band.width / kMillimetre, width / kMillimetre));
    std::vector<stroke::StrokeSamples*> copies;
    for (std::size_t first = 0; first < strokes.size(); first += n)
        for (const std::size_t i : drawn) copies.push_back(&strokes[first + i].as<stroke::PaintStroke>()->trace);
    finish_strokes(strokes, {std::move(copies), band.scale, std::max(band.width, band.height)}, a, console);
    const writer::PathPlace first = writer::place_on(on.path, 0, writer::kBandReach * band.step);
    return {.at = first.position,
            .normal = first.normal,
            .size = band.scale * Vec2(extent.size()),
            .repeats = band.repeats,
            .step = band.step,
            .path = length};
}

}  // namespace tuft::cli
