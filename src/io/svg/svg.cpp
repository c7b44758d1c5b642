#include "io/svg/svg.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "io/motion/motion_files.h"
#include "io/package/xml_entities.h"
#include "io/package/xml_fault.h"
#include "io/strokes/area_lines.h"
#include "io/strokes/inkml_marks.h"
#include "io/svg/style/svg_page.h"
#include "io/svg/svg_areas.h"
#include "io/svg/svg_scene.h"
#include "io/svg/svg_stroke.h"

namespace tuft::io {
namespace {

constexpr double kSpacing = 5e-4;  // metres, of samples on a straight line
constexpr double kDot = 0.05;      // of its width, half of the line that stands for a point

// A line of the drawing; metres.
struct Drawn {
    SvgLine line;
    double width = 0;                    // of its stroke; 0: it has none
    double taper_in = 0, taper_out = 0;  // lengths over which it runs out into a point
    std::vector<stroke::StencilEdge> stencil = {};
    std::vector<Ring> outline = {};  // of its stroke
    std::string group = {};
};

// A drawing is often painted larger than its file says: a thousandth of a percent of it is out of sight.
double area_tolerance(const SvgScene& scene, double most) {
    const double size = glm::length(scene.page);
    return size > 0 ? std::clamp(1e-5 * size, 1e-3 * most, most) : 0.1 * most;
}

/// Lines of a scene for a brush.
class BrushLines {
  public:
    BrushLines(SvgScene& scene, const std::string& source, const SvgOptions& options)
        : scene_(scene), source_(source), options_(options) {}

    std::vector<Drawn> draw() {
        for (const SvgShape& s : scene_.shapes) {
            if (s.fixed_width && s.style.stroked())
                add_shape(svg_with_own_width(s, scene_.unit));
            else
                add_shape(s);
        }
        return std::move(lines_);
    }

  private:
    void add_shape(const SvgShape& s) {
        const bool wide = s.style.visible && s.style.stroked() && !options_.outlines &&
                          s.style.pen.width * svg_growth(s.matrix) >= options_.wide;
        const std::size_t before = lines_.size();
        const std::size_t whole = add_lines(s);
        if (whole == 0 && !s.style.stroked()) return;
        count_paints(s.style);
        if (s.style.bare())
            lines_.resize(before);
        else if (s.style.filled() && whole > 0)
            fill(before, s.style);
        if (s.style.stroked() && (wide || options_.outlines || whole == 0 || !s.style.pen.dashes.empty())) {
            lines_.resize(lines_.size() - whole);
            if (!wide || !add_wide(s)) add_strokes(s);
        }
        for (std::size_t i = before; i < lines_.size(); ++i) lines_[i].group = s.group;
    }

    // The lines of the shape, without dashes; how many.
    std::size_t add_lines(const SvgShape& s) {
        width_ = s.style.stroked() ? std::min(s.style.pen.width * svg_growth(s.matrix), options_.ink.max_extent) : 0;
        if (!std::isfinite(width_)) width_ = 0;
        const std::size_t before = lines_.size();
        for (const SvgLine& line : s.lines) emit(line, s);
        return lines_.size() - before;
    }

    // A wide line is an area with the ends and corners that the file gives it.
    bool add_wide(const SvgShape& s) {
        std::vector<AreaLine> lines =
            area_lines(svg_stroke_outline(s, scene_.unit, options_.tolerance), FillRule::nonzero);
        for (AreaLine& line : lines) lines_.push_back(counted(std::move(line)));
        return !lines.empty();
    }

    Drawn counted(AreaLine line) {
        n_points_ += line.line.size() + line.stencil.size();
        check_points();
        return {.line = std::move(line.line),
                .width = line.width,
                .taper_in = line.taper_in,
                .taper_out = line.taper_out,
                .stencil = std::move(line.stencil)};
    }

    // The stroke of a shape, each dash a line of its own, with what it covers.
    void add_strokes(const SvgShape& s) {
        const double tolerance = area_tolerance(scene_, options_.tolerance);
        SvgShape one{.matrix = s.matrix, .style = s.style};
        one.style.pen.dashes.clear();
        for (const SvgLine& line : s.lines)
            for (SvgLine& dash : s.style.pen.dashes.empty() || line.size() < 2
                                     ? std::vector<SvgLine>{line}
                                     : svg_dashed(line, s.style.pen.dashes, s.style.pen.dash_offset)) {
                const std::size_t before = lines_.size();
                if (emit(dash, s); lines_.size() == before) emit(dot_of(dash, s.style), s);
                if (lines_.size() == before || !options_.outlines) continue;
                one.lines = {std::move(dash)};
                lines_.back().outline = svg_stroke_outline(one, scene_.unit, tolerance);
                for (const Ring& ring : lines_.back().outline) n_points_ += ring.size();
                check_points();
            }
    }

    // A point shows its ends, a brush needs a line.
    static SvgLine dot_of(const SvgLine& line, const SvgStyle& style) {
        if (line.empty() || style.pen.cap == SvgCap::butt) return {};
        const Vec2 half(kDot * style.pen.width, 0);
        return {line.front() - half, line.front() + half};
    }

    void check_points() const {
        if (n_points_ > options_.ink.max_samples) throw Error(source_, "the drawing has too many points");
    }

    // The lines from `before` on are outlines of one area: lines that fill it come before them where they are
    // drawn themselves, else in their place.
    void fill(std::size_t before, const SvgStyle& style) {
        std::vector<SvgLine> rings;
        for (std::size_t i = before; i < lines_.size(); ++i) rings.push_back(lines_[i].line);
        std::vector<Drawn> area;
        for (AreaLine& line : area_lines(rings, style.rule)) area.push_back(counted(std::move(line)));
        if (area.empty()) {  // a line, drawn as such unless it says that it has a stroke, which paints nothing
            if (!style.stroked() && style.stroke.kind != SvgPaint::Kind::none) lines_.resize(before);
            return;
        }
        if (style.fill.kind == SvgPaint::Kind::flat) scene_.losses.add_colour(style.fill.colour);
        if (!style.stroked()) lines_.resize(before);
        lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(before), std::make_move_iterator(area.begin()),
                      std::make_move_iterator(area.end()));
    }

    // How the shape just drawn is painted.
    void count_paints(const SvgStyle& style) {
        using Kind = SvgPaint::Kind;
        SvgLosses& losses = scene_.losses;
        const auto either = [&](Kind kind) { return style.fill.kind == kind || style.stroke.kind == kind; };
        if (either(Kind::white)) losses.add(SvgLoss::white);
        if (either(Kind::missing)) losses.add(SvgLoss::missing_paint);
        if (either(Kind::gradient)) losses.add(SvgLoss::gradient);
        if (either(Kind::pattern)) losses.add(SvgLoss::pattern);
        if (style.marked()) losses.add(SvgLoss::marker);
        if ((style.filled() && style.fill_opacity < 1) || (style.stroked() && style.stroke_opacity < 1))
            losses.add(SvgLoss::opacity);
        if (style.stroked() && style.stroke.kind == Kind::flat) losses.add_colour(style.stroke.colour);
    }

    void emit(const SvgLine& line, const SvgShape& s) {
        SvgLine out;
        for (const Vec2& p : line) {
            const Vec2 q(s.matrix * Vec3(p, 1));
            if (!(std::abs(q.x) < options_.ink.max_extent && std::abs(q.y) < options_.ink.max_extent))
                throw Error(source_, "the drawing is absurdly large");
            // Pressure is laid out along the samples, so long chords need some.
            const int n = out.empty() ? 1
                                      : static_cast<int>(std::clamp(glm::distance(out.back(), q) / kSpacing, 1.0,
                                                                    static_cast<double>(SvgCurves::kMost)));
            const Vec2 from = out.empty() ? q : out.back();
            if (!out.empty() && q == from) continue;
            for (int i = 1; i <= n; ++i) out.push_back(glm::mix(from, q, static_cast<double>(i) / n));
        }
        if (out.size() < 2) return;
        n_points_ += out.size();
        check_points();
        lines_.push_back({.line = std::move(out), .width = width_});
    }

    SvgScene& scene_;
    const std::string& source_;
    const SvgOptions& options_;
    double width_ = 0;
    std::vector<Drawn> lines_;
    std::size_t n_points_ = 0;
};

constexpr double kFuller = 1.3;  // than a corner is wide: a tuft that runs into one, on stencil edge

// Where a line has a width, pressures say which part of it is drawn.
void give_width(stroke::RecordedStroke& trace, const Drawn& drawn, double full) {
    trace.line_width = drawn.width;
    if (drawn.width <= 0) return;
    double whole = 0, along = 0;
    for (std::size_t i = 1; i < drawn.line.size(); ++i) whole += glm::distance(drawn.line[i - 1], drawn.line[i]);
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        if (i > 0) along += glm::distance(trace.samples[i - 1].position, trace.samples[i].position);
        const double in = drawn.taper_in > 0 ? std::min(1.0, kFuller * along / drawn.taper_in) : 1,
                     out = drawn.taper_out > 0 ? std::min(1.0, kFuller * (whole - along) / drawn.taper_out) : 1;
        trace.samples[i].pressure = full * std::clamp(std::min(in, out), 0.0, 1.0);
    }
}

std::vector<stroke::RecordedStroke> traces_of(const std::vector<Drawn>& lines, const std::string& source,
                                              const InkmlOptions& options) {
    std::ostringstream ink;
    ink.precision(12);
    ink << "<ink xmlns='http://www.w3.org/2003/InkML'>";
    for (const Drawn& drawn : lines) {
        const SvgLine& line = drawn.line;
        ink << "<trace>";
        for (std::size_t i = 0; i < line.size(); ++i)
            ink << (i ? "," : "") << 1e3 * line[i].x << ' ' << 1e3 * line[i].y;
        ink << "</trace>";
    }
    ink << "</ink>";
    std::vector<stroke::RecordedStroke> traces = parse_inkml(ink.str(), source, options);
    for (std::size_t i = 0; i < traces.size(); ++i) {
        give_width(traces[i], lines.at(i), options.flat_pressure);
        traces[i].stencil = lines.at(i).stencil;
        traces[i].outline = lines.at(i).outline;
        traces[i].group = lines.at(i).group;
    }
    return traces;
}

void report_losses(const std::vector<Message>& losses, bool nothing, const std::string& source,
                   const InkmlOptions& options) {
    if (nothing && losses.empty()) throw Error(source, "nothing is drawn in this file");
    if (nothing) throw Error(source, Message("nothing is drawn in this file; {}", losses.front()));
    if (options.note)
        for (const Message& loss : losses) options.note(loss);
}

/// Leaves the shapes of the groups asked for.
void keep_groups(SvgScene& scene, const std::vector<std::string>& names, const std::string& source) {
    if (names.empty()) return;
    std::set<std::string> all;
    for (const SvgShape& s : scene.shapes)
        if (!s.group.empty()) all.insert(s.group);
    for (const std::string& name : names)
        if (!all.contains(name)) {
            std::string list;
            for (const std::string& one : all) list += (list.empty() ? "" : ", ") + one;
            throw Error(source, Message("there is no layer or group '{}'; there are: {}", name, list));
        }
    std::erase_if(scene.shapes,
                  [&](const SvgShape& s) { return std::find(names.begin(), names.end(), s.group) == names.end(); });
}

/// The drawing as areas in its colours; nothing where it is for a brush.
std::optional<std::vector<stroke::RecordedStroke>> coloured(const pugi::xml_node& svg, const std::string& source,
                                                            const SvgOptions& options) {
    if (options.painting == SvgPainting::brush) return {};
    SvgSceneOptions how{.brush = false,
                        .tolerance = options.tolerance,
                        .max_points = options.ink.max_samples,
                        .folder = options.folder};
    const SvgPage page = svg_page(svg, source);
    how.tolerance = area_tolerance({.page = page.size}, options.tolerance);
    SvgScene scene = read_svg_scene(svg, source, how);
    keep_groups(scene, options.groups, source);
    if (options.painting == SvgPainting::automatic && !has_colours(scene)) return {};
    std::vector<stroke::RecordedStroke> areas = svg_areas(scene, source, how.tolerance);
    report_losses(scene.losses.lines(), areas.empty(), source, options.ink);
    return areas;
}

}  // namespace

std::vector<stroke::RecordedStroke> parse_svg(std::string_view text, const std::string& source,
                                              const SvgOptions& options) {
    pugi::xml_document document;
    const std::string expanded = expand_entities(text, source);
    const auto parsed = document.load_buffer(expanded.data(), expanded.size());
    if (!parsed) throw Error(source, Message("not well formed: {}", xml_fault(parsed)));
    const pugi::xml_node svg = document.document_element();
    if (local_name(svg) != "svg") throw Error(source, "not an SVG drawing");
    if (auto areas = coloured(svg, source, options)) return std::move(*areas);
    SvgScene scene = read_svg_scene(
        svg, source, {.brush = true, .tolerance = options.tolerance, .max_points = options.ink.max_samples});
    keep_groups(scene, options.groups, source);
    const std::vector<Drawn> lines = BrushLines(scene, source, options).draw();
    report_losses(scene.losses.lines(), lines.empty(), source, options.ink);
    return traces_of(lines, source, options.ink);
}

std::vector<stroke::RecordedStroke> read_svg(const std::filesystem::path& path, const SvgOptions& options) {
    const std::vector<char> bytes = read_file(path, options.ink.max_bytes);
    SvgOptions own = options;
    own.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    return parse_svg({bytes.data(), bytes.size()}, path.string(), own);
}

std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const SvgOptions& options) {
    const std::string extension = lower_extension(path);
    if (extension == ".json" || extension == ".csv") return read_trajectory(path);
    return extension == ".svg" ? read_svg(path, options) : read_inkml(path, options.ink);
}

std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const InkmlOptions& options) {
    return read_strokes(path, SvgOptions{.ink = options});
}

}  // namespace tuft::io
