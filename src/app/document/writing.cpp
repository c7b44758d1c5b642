#include "app/document/writing.h"

#include <algorithm>
#include <cmath>

#include "brush/preset.h"
#include "core/error.h"
#include "io/svg.h"
#include "stroke/hand/line_width.h"
#include "stroke/hand/practise.h"
#include "stroke/hand/placement.h"

namespace tuft::app {

namespace {

bool same_place(const stroke::Placement& a, const stroke::Placement& b) {
    return a.origin == b.origin && a.right == b.right && a.down == b.down;
}

// Parts that the file puts at places of their own, such as characters round a bowl, would lie over
// each other at one place.
void set_side_by_side(std::vector<stroke::Trace>& traces) {
    double edge = 0;
    for (std::size_t i = 0; i < traces.size();) {
        std::size_t end = i;
        Box box;
        for (; end < traces.size() && same_place(traces[end].placement, traces[i].placement); ++end)
            stroke::add_extent(box, traces[end]);
        const Vec3 shift = i == 0 ? Vec3(0) : Vec3(edge - box.lo.x + 0.15 * std::max(box.size().x, box.size().y), 0, 0);
        for (; i < end; ++i)
            for (stroke::TraceSample& s : traces[i].samples) s.position += shift;
        edge = box.hi.x + shift.x;
    }
}

}  // namespace

Writing read_writing(const std::filesystem::path& file, const std::function<void(const std::string&)>& note) {
    Writing out{.file = file, .traces = io::read_strokes(file, {.note = note})};
    std::erase_if(out.traces, [](const stroke::Trace& t) { return !t.flat || t.samples.empty(); });
    if (out.traces.empty()) throw Error(file.string(), "its strokes lie in space already; only flat writing can be placed");
    set_side_by_side(out.traces);
    Box box;
    for (const stroke::Trace& trace : out.traces) stroke::add_extent(box, trace);
    for (stroke::Trace& trace : out.traces)
        for (stroke::TraceSample& s : trace.samples) s.position -= box.centre();
    out.width = box.size().x;
    out.height = box.size().y;
    return out;
}

stroke::Placement place_writing(const Writing& w, const mesh::SurfacePoint& at, const Vec3& normal, const Vec3& right) {
    Vec3 x = right - glm::dot(right, normal) * normal;
    x = glm::length(x) > 1e-6 ? glm::normalize(x) : make_frame(at.position, normal).t;
    const Vec3 y = glm::cross(x, normal);  // down, as seen from outside
    const double c = std::cos(w.turn), s = std::sin(w.turn);
    return {.origin = at.position, .right = c * x + s * y, .down = -s * x + c * y, .laying = w.laying};
}

std::vector<stroke::Trace> placed_traces(const Writing& w, const stroke::Placement& placement, double pressure) {
    std::vector<stroke::Trace> traces = w.traces;
    for (stroke::Trace& trace : traces) {
        trace.placement = placement;
        trace.placed = true;
        trace.before.clear();
        if (!trace.brush.empty()) {
            const brush::SizedName own = brush::sized_name(trace.brush);
            trace.brush = brush::name_of({own.base, own.factor * w.scale});
        }
        for (stroke::TraceSample& s : trace.samples) {
            s.position *= w.scale;
            s.time *= std::max(0.2, w.scale);  // the same pace for larger letters
            if (!trace.pressed && !(w.own_width && trace.line_width > 0)) s.pressure = std::min(1.0, s.pressure * pressure);
        }
        for (stroke::TapeEdge& edge : trace.tape) edge = {w.scale * edge.from, w.scale * edge.to};
        trace.line_width = w.own_width && !trace.pressed ? w.scale * trace.line_width : 0;
    }
    return traces;
}

bool has_widths(const Writing& w) {
    return std::any_of(w.traces.begin(), w.traces.end(), [](const auto& t) { return t.line_width > 0 && !t.pressed; });
}

void draw_to_widths(std::vector<stroke::Trace>& traces) {
    stroke::WidthTables widths;
    std::vector<stroke::Trace*> drawn;
    for (stroke::Trace& trace : traces) {
        if (trace.line_width > 0) {
            trace.brush = stroke::brush_for_width(trace.brush, widths.of(trace.brush), trace.line_width);
            stroke::draw_to_width(trace, widths.of(trace.brush));
            drawn.push_back(&trace);
        }
    }
    stroke::practise(drawn, widths);
    for (stroke::Trace& trace : traces) trace.line_width = 0;
}

std::vector<std::vector<GhostPoint>> ghost_lines(const mesh::SurfaceQuery& query, const Writing& w, const stroke::Placement& placement, std::size_t most) {
    std::size_t all = 0;
    for (const stroke::Trace& trace : w.traces) all += trace.samples.size();
    const std::size_t step = std::max<std::size_t>(1, all / most);
    // All in one trace: what is found out about the ground is found once.
    stroke::Trace thin{.placement = placement};
    std::vector<std::size_t> starts;
    for (const stroke::Trace& trace : w.traces) {
        starts.push_back(thin.samples.size());
        const std::size_t n = trace.samples.size();
        for (std::size_t i = 0; i < n; i += step) thin.samples.push_back(trace.samples[i]);
        if ((n - 1) % step != 0) thin.samples.push_back(trace.samples.back());
    }
    for (stroke::TraceSample& s : thin.samples) s.position *= w.scale;
    const std::vector<stroke::LaidSample> laid = stroke::lay(query, thin).samples;
    std::vector<std::vector<GhostPoint>> lines;
    for (std::size_t i = 0, next = 0; i < laid.size(); ++i) {
        while (next < starts.size() && starts[next] == i) {
            lines.emplace_back();
            ++next;
        }
        if (laid[i].on_surface) lines.back().push_back({laid[i].position, laid[i].normal});
        else if (!lines.back().empty()) lines.emplace_back();
    }
    return lines;
}

}  // namespace tuft::app
