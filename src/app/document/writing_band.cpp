#include "app/document/writing_band.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"

namespace tuft::app {
namespace {

writer::ModelPath path_at(const Writing& w, const BandSurface& surface, const Vec3& at) {
    if (w.along == BandLine::edge)
        return surface.lines.nearest(at, writer::feature_reach(surface.query.mesh().bounds)).path;
    if (w.along == BandLine::curve) {
        writer::ModelPath path = path_of_curve(surface.query, surface.curve);
        writer::close_where_ends_meet(path);
        return path;
    }
    const auto on = surface.query.closest_point(at);
    if (!on) throw Error(Message("the model has no surface"));
    return writer::level_section(surface.query, on->position);
}

}  // namespace

WritingBand lay_band(const Writing& w, const BandSurface& surface, const Vec3& at) {
    WritingBand out{.path = {}, .band = {}, .places = {}, .at = rounded_place(at)};
    out.path = path_at(w, surface, out.at);
    out.band = writer::band_of(
        out.path.length(), w.form().box,
        {.repeats = w.repeats, .width = painted_width(w), .mirrored = w.mirrored, .texel = surface.texel});
    out.places = writer::band_places(out.path, out.band);
    return out;
}

std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Writing& w,
                                                     const WritingBand& on, std::size_t most) {
    constexpr std::size_t kLeast = 24;       // of a copy
    constexpr std::size_t kMostLines = 600;  // a ghost follows the cursor: of more, each copy is a frame
    std::vector<std::vector<Vec2>> drawn = drawn_lines(w.form());
    if (drawn.size() * on.places.size() > kMostLines) {
        const Vec2 lo(w.form().box.lo), hi(w.form().box.hi);
        drawn = {{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}, lo}};
    }
    const std::size_t each = std::max(kLeast, most / on.places.size());
    std::vector<std::vector<PreviewPoint>> all;
    for (const writer::BandPlace& place : on.places) {
        std::vector<std::vector<Vec2>> lines;
        lines.reserve(drawn.size());
        for (const std::vector<Vec2>& line : drawn)
            lines.push_back(writer::line_in_band(line, w.form().centre, on.band, place.curvature));
        stroke::Placement placement = place.placement;
        placement.mapping = w.mapping;
        std::vector<std::vector<PreviewPoint>> copy = preview_lines(query, lines, placement, each);
        std::ranges::move(copy, std::back_inserter(all));
    }
    return all;
}

PlacedWriting placed_writing(const Writing& w, const WritingBand& on, const WritingHand& hand) {
    PlacedWriting out = unplaced_writing(w, hand);
    out.entries = writer::repeat_along(out.entries, on.places, w.form().centre, on.band, true);
    out.scale = on.band.scale;
    out.extent = std::max(on.band.width, on.band.height);
    return out;
}

std::string place_words(const Writing& w, const WritingBand& on) {
    const Vec3 at = on.at / kMillimetre;
    std::string words = "--along ";
    if (w.along == BandLine::curve)
        words += "FILE";
    else
        words += fmt::format("{} --place {:.3f},{:.3f},{:.3f}", w.along == BandLine::edge ? "edge" : "rim", at.x, at.y,
                             at.z);
    if (w.repeats > 0) words += fmt::format(" --repeat {}", w.repeats);
    return words + size_words(w);
}

}  // namespace tuft::app
