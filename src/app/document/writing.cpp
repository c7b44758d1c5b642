#include "app/document/writing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/text/units.h"
#include "io/svg/svg.h"
#include "stroke/journal/entries.h"

namespace tuft::app {

namespace {

constexpr double kPlaceStep = 1000, kTurnStep = 100,
                 kEyeStep = 1e6;  // steps in a millimetre, in a degree, in a unit vector

double rounded(double value, double steps) {
    return std::round(value * steps) / steps;
}

Vec3 rounded_direction(const Vec3& v) {
    return {rounded(v.x, kEyeStep), rounded(v.y, kEyeStep), rounded(v.z, kEyeStep)};
}

double width_mm(const Writing& w) {
    return rounded(w.scale * w.form().width / kMillimetre, kPlaceStep);
}

std::vector<stroke::StrokeSamples*> pointers(std::vector<stroke::RecordedStroke>& traces) {
    std::vector<stroke::StrokeSamples*> all;
    all.reserve(traces.size());
    for (stroke::RecordedStroke& trace : traces) all.push_back(&trace);
    return all;
}

// Fills and washes are of the model and the palette, not of a drawing that is placed by hand.
bool belongs_to_brush(const stroke::Preparation& preparation) {
    return std::holds_alternative<stroke::BrushAction>(preparation) || std::holds_alternative<stroke::Dry>(preparation);
}

bool is_svg(const std::filesystem::path& file) {
    return lower_extension(file) == ".svg";
}

std::vector<stroke::FlatArea*> areas_of(std::vector<stroke::RecordedStroke>& traces) {
    std::vector<stroke::FlatArea*> all;
    for (stroke::RecordedStroke& trace : traces)
        for (stroke::Preparation& one : trace.before)
            if (auto* fill = std::get_if<stroke::Fill>(&one); fill && fill->area) all.push_back(&*fill->area);
    return all;
}

void set_size(WritingForm& form, const Box& box) {
    form.centre = Vec2(box.centre());
    form.width = stroke::width_of(box);
    form.height = box.size().y;
    form.box = box;
}

WritingForm read_form(const std::filesystem::path& file, io::SvgPainting painting) {
    WritingForm out;
    out.traces = io::read_strokes(
        file,
        io::SvgOptions{.painting = painting, .ink = {.note = [&](const Message& line) { out.notes.push_back(line); }}});
    return out;
}

WritingForm line_form(const std::filesystem::path& file, WritingForm out) {
    std::erase_if(out.traces,
                  [](const stroke::RecordedStroke& t) { return !t.flat || t.on_palette || t.samples.empty(); });
    if (out.traces.empty())
        throw Error(file.string(), "its strokes lie in space already; only flat writing can be placed");
    const std::vector<stroke::StrokeSamples*> all = pointers(out.traces);
    stroke::arrange_parts(all);
    set_size(out, stroke::extent_of(all));
    return out;
}

WritingForm area_form(WritingForm out) {
    std::erase_if(out.traces, [](const stroke::RecordedStroke& t) { return t.before.empty(); });
    const std::vector<stroke::FlatArea*> areas = areas_of(out.traces);
    Box box;
    for (const stroke::FlatArea* area : areas) stroke::add_extent(box, *area);
    set_size(out, box);
    return out;
}

std::size_t count_inks(Writing& w) {
    std::set<std::string> inks;
    for (const stroke::RecordedStroke& trace : w.lines.traces) inks.insert(trace.ink);
    for (const stroke::FlatArea* area : areas_of(w.areas.traces))
        for (const stroke::AreaStop& stop : area->stops) inks.insert(stop.ink);
    inks.erase("");
    return inks.size();
}

}  // namespace

std::vector<std::vector<Vec2>> read_sketch(const std::filesystem::path& file) {
    WritingForm form;
    try {
        form = read_form(file, io::SvgPainting::automatic);
        form = is_svg(file) && !areas_of(form.traces).empty() ? area_form(std::move(form))
                                                              : line_form(file, std::move(form));
    } catch (const Error&) {  // of its areas: the file may have lines nevertheless
        if (!is_svg(file)) throw;
        form = line_form(file, read_form(file, io::SvgPainting::brush));
    }
    const double span = std::max({form.width, form.height, 1e-9});
    std::vector<std::vector<Vec2>> lines = drawn_lines(form);
    for (std::vector<Vec2>& line : lines)
        for (Vec2& p : line) p = (p - form.centre) / span + 0.5;
    return lines;
}

Writing read_writing(const std::filesystem::path& file) {
    Writing out{.file = file};
    std::optional<Error> fault;  // of the areas: the file may have lines nevertheless
    std::optional<WritingForm> lines;
    try {
        WritingForm form = read_form(file, io::SvgPainting::automatic);
        if (is_svg(file) && !areas_of(form.traces).empty())
            out.areas = area_form(std::move(form));
        else
            lines = std::move(form);
    } catch (const Error& e) {
        if (!is_svg(file)) throw;
        fault = e;
    }
    try {
        if (!lines) lines = read_form(file, io::SvgPainting::brush);
        out.lines = line_form(file, std::move(*lines));
    } catch (const Error&) {
        if (fault) throw *fault;
        if (out.areas.traces.empty()) throw;  // a picture has no lines
    }
    if (!out.lines.traces.empty() && out.lines.traces.front().placed)
        out.mapping = out.lines.traces.front().placement.mapping;
    out.own_ink = out.lines.traces.empty() || count_inks(out) > 1;
    return out;
}

Vec3 rounded_place(const Vec3& at) {
    Vec3 place = at;
    for (int k = 0; k < 3; ++k) place[k] = kMillimetre * rounded(at[k] / kMillimetre, kPlaceStep);
    return place;
}

stroke::Placement place_flat(const mesh::SurfaceQuery& query, const Vec3& at, const Vec3& normal, const Vec3& right,
                             const Vec3& eye, const FlatPose& pose) {
    const Vec3 place = rounded_place(at);
    const auto on = query.closest_point(place);
    if (!on) return {.origin = at};
    const Vec3 n = glm::dot(on->normal, normal) < 0 ? -on->normal : on->normal;
    const auto turned = [&](const Vec3& facing, const Vec3& upright) {
        const stroke::Placement seen = stroke::placement_seen(place, facing, right, -pose.turn);
        return kDegree * rounded(stroke::turn_of(facing, upright, seen.right) / kDegree, kTurnStep);
    };
    stroke::Placement out;
    if (pose.mapping == stroke::SurfaceMapping::project) {
        // Straight through the picture: as it is seen now it comes to lie.
        const Vec3 from = rounded_direction(eye), towards = glm::normalize(from), upright = stroke::reading_right(from);
        out = stroke::placement_seen(on->position, towards, upright, turned(towards, upright));
    } else {
        out = stroke::upright_placement(on->position, n, turned(n, stroke::upright_right(n)));
    }
    out.mapping = pose.mapping;
    return out;
}

stroke::Placement place_writing(const Writing& w, const mesh::SurfaceQuery& query, const Vec3& at, const Vec3& normal,
                                const Vec3& right, const Vec3& eye) {
    return place_flat(query, at, normal, right, eye, {w.turn, w.mapping});
}

double painted_width(const Writing& w) {
    return width_mm(w) * kMillimetre;
}

double painted_scale(const Writing& w) {
    const double width = w.form().width;
    return width > 0 && width_mm(w) > 0 ? width_mm(w) * kMillimetre / width : w.scale;
}

namespace {

std::string place_words(const stroke::Placement& p, stroke::SurfaceMapping mapping, const std::string& size) {
    const Vec3 normal = glm::normalize(glm::cross(p.down, p.right));
    const Vec3 at = p.origin / kMillimetre;
    const bool project = mapping == stroke::SurfaceMapping::project;
    const Vec3 from = rounded_direction(normal),
               upright = project ? stroke::reading_right(from) : stroke::upright_right(normal);
    const double turn = std::round(100 * stroke::turn_of(normal, upright, p.right) / kDegree) / 100;
    std::string words = fmt::format("--place {:.3f},{:.3f},{:.3f}{} --place-turn {:.2f}", at.x, at.y, at.z, size,
                                    turn + 0.0);  // without the sign of -0
    if (mapping != stroke::SurfaceMapping::drape)
        words += " --mapping " + std::string(stroke::surface_mapping_name(mapping));
    if (project) words += fmt::format(" --read-from {:.6f},{:.6f},{:.6f}", from.x, from.y, from.z);
    return words;
}

std::string kind_words(const Writing& w) {
    std::string words;
    if (w.mirrored) words += " --place-mirror";
    if (is_svg(w.file)) words += w.in_colours() ? " --areas mask" : " --areas brush";
    return words;
}

}  // namespace

std::string place_words(const stroke::Placement& p) {
    return place_words(p, p.mapping, "");
}

std::string place_words(const Writing& w, const stroke::Placement& p) {
    return place_words(p, w.mapping, fmt::format(" --place-width {:.3f}", width_mm(w))) + kind_words(w);
}

std::string size_words(const Writing& w) {
    std::string words = fmt::format(" --place-width {:.3f}", width_mm(w));
    if (w.mapping != stroke::SurfaceMapping::drape)
        words += " --mapping " + std::string(stroke::surface_mapping_name(w.mapping));
    return words + kind_words(w);
}

std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\n')
            out += "\\n";
        else if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    return out + "'";
}

bool has_widths(const Writing& w) {
    return std::ranges::any_of(w.form().traces, [](const auto& t) { return t.line_width > 0 && !t.pressed; });
}

PlacedWriting unplaced_writing(const Writing& w, const WritingHand& hand) {
    std::vector<stroke::RecordedStroke> traces = w.form().traces;
    for (stroke::FlatArea* area : areas_of(traces)) area->placement.mapping = w.mapping;
    for (stroke::RecordedStroke& trace : traces) {
        if (!w.in_colours())
            std::erase_if(trace.before, [](const stroke::Preparation& p) { return !belongs_to_brush(p); });
        trace.placement.mapping = w.mapping;
        trace.names = {};
        if (!w.own_width) trace.line_width = 0;
        if (!trace.pressed && !(trace.line_width > 0))
            for (stroke::StrokeSample& s : trace.samples) s.pressure = std::min(1.0, s.pressure * hand.pressure);
    }
    PlacedWriting out{.entries = {},
                      .scale = painted_scale(w),
                      .extent = 0,
                      .fit = {.grow = w.own_ink, .fit = w.own_width, .otherwise = hand.brush}};
    stroke::EntryOptions options;
    options.brush = w.own_ink ? "" : hand.brush;
    options.ink = w.own_ink ? "" : hand.ink;
    options.other_ink = hand.ink;
    stroke::append_entries(out.entries, std::move(traces), options);
    return out;
}

PlacedWriting placed_writing(const Writing& w, const stroke::Placement& placement, const WritingHand& hand) {
    PlacedWriting out = unplaced_writing(w, hand);
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(out.entries, true);
    const stroke::DrawingPlace place{placement, w.form().centre, out.scale, w.mirrored};
    stroke::place_drawing(drawing, place);
    stroke::place_areas(stroke::areas_in(out.entries, true), place);
    const Box box = stroke::extent_of(drawing);
    out.extent = std::max(box.size().x, box.size().y);
    return out;
}

std::vector<std::vector<Vec2>> drawn_lines(const WritingForm& form) {
    std::vector<std::vector<Vec2>> lines;
    for (const stroke::RecordedStroke& trace : form.traces) {
        if (!trace.samples.empty()) {
            std::vector<Vec2>& line = lines.emplace_back();
            for (const stroke::StrokeSample& s : trace.samples) line.emplace_back(s.position);
        }
        for (const stroke::Preparation& one : trace.before)
            if (const auto* fill = std::get_if<stroke::Fill>(&one); fill && fill->area)
                for (const std::vector<Vec2>& ring : fill->area->rings) {
                    if (ring.empty()) continue;
                    lines.push_back(ring);
                    lines.back().push_back(ring.front());
                }
    }
    return lines;
}

std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Writing& w,
                                                     const stroke::Placement& placement, std::size_t most) {
    std::vector<std::vector<Vec2>> lines;
    const double scale = painted_scale(w);
    for (const std::vector<Vec2>& drawn : drawn_lines(w.form())) {
        std::vector<Vec2>& line = lines.emplace_back();
        for (const Vec2& at : drawn) {
            const Vec2 p = scale * (at - w.form().centre);
            line.emplace_back(w.mirrored ? -p.x : p.x, p.y);
        }
    }
    return preview_lines(query, lines, placement, most);
}

std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query,
                                                     const std::vector<std::vector<Vec2>>& lines,
                                                     const stroke::Placement& placement, std::size_t most) {
    std::size_t all = 0;
    for (const std::vector<Vec2>& line : lines) all += line.size();
    const std::size_t step = std::max<std::size_t>(1, all / most);
    // All in one trace: what is found out about the surface is found once.
    stroke::StrokeSamples thin{.placement = placement};
    std::vector<std::size_t> starts;
    for (const std::vector<Vec2>& line : lines) {
        starts.push_back(thin.samples.size());
        for (std::size_t i = 0; i < line.size(); i += step) thin.samples.push_back({.position = Vec3(line[i], 0)});
        if (!line.empty() && (line.size() - 1) % step != 0) thin.samples.push_back({.position = Vec3(line.back(), 0)});
    }
    const std::vector<stroke::SurfaceSample> mapped = stroke::map_to_surface(query, thin).samples;
    std::vector<std::vector<PreviewPoint>> parts;
    for (std::size_t i = 0, next = 0; i < mapped.size(); ++i) {
        while (next < starts.size() && starts[next] == i) {
            parts.emplace_back();
            ++next;
        }
        if (mapped[i].on_surface)
            parts.back().push_back({.position = mapped[i].position, .normal = mapped[i].normal});
        else if (!parts.back().empty())
            parts.emplace_back();
    }
    return parts;
}

}  // namespace tuft::app
