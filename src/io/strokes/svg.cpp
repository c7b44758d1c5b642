#include "io/strokes/svg.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>

#include "core/error.h"
#include "core/system/files.h"
#include "core/system/interrupt.h"
#include "io/model/xml_fault.h"
#include "io/strokes/area_lines.h"
#include "io/strokes/svg_losses.h"
#include "io/strokes/svg_shapes.h"
#include "io/strokes/svg_style.h"

namespace tuft::io {
namespace {

constexpr double kPixel = 0.0254 / 96;                   // metres of a CSS pixel
constexpr double kSpacing = 5e-4;                        // metres, of samples on a straight line
constexpr int kDeepest = 64;                             // of nested groups
constexpr std::size_t kMostElements = 1'000'000;         // drawn, each `use` of one counted
constexpr std::size_t kMostText = std::size_t{1} << 30;  // bytes of attributes read, those of each `use` counted

// A line of the drawing; metres.
struct Drawn {
    SvgLine line;
    double width = 0;                    // of its stroke; 0: it has none
    double taper_in = 0, taper_out = 0;  // lengths over which it runs out into a point
    std::vector<stroke::StencilEdge> stencil = {};
};

class Drawing {
  public:
    Drawing(const std::string& source, const SvgOptions& options) : source_(source), options_(options) {}

    void walk(const pugi::xml_node& node, SvgMatrix matrix, SvgStyle style, int depth) {
        if (depth > kDeepest) throw Error(source_, "groups are nested too deeply");
        check_interrupt();
        if (++n_elements_ > kMostElements) throw Error(source_, "there are too many elements in it");
        for (const pugi::xml_attribute& one : node.attributes()) n_text_ += std::strlen(one.value());
        if (n_text_ > kMostText) throw Error(source_, "what 'use' repeats makes it too large");
        const std::string name = local(node.name());
        static constexpr const char* skipped[] = {"defs",    "symbol",   "clipPath", "mask",  "marker",
                                                  "pattern", "metadata", "style",    "title", "desc"};
        if (std::find(std::begin(skipped), std::end(skipped), name) != std::end(skipped) || is_lost(node, name)) return;
        const Properties own(node, sheet_.declared(node, name));
        if (own("display") == "none" || opacity(own("opacity"), 1) == 0) return;
        inherit(style, own);
        if (name == "text" || name == "image") {
            if (style.visible) losses_.add(name == "text" ? SvgLoss::text : SvgLoss::image);
            return;
        }
        count_effects(own);
        if (name == "svg" && depth > 0 && (node.attribute("x") || node.attribute("y") || node.attribute("viewBox")))
            losses_.add(SvgLoss::frame);
        if (const auto transform = node.attribute("transform"))
            matrix = matrix * svg_transform(transform.value(), source_);
        if (name == "use") return use(node, matrix, style, depth);
        matrix_ = matrix;
        width_ = style.stroked() ? std::min(style.width * growth(), options_.ink.max_extent) : 0;
        if (!std::isfinite(width_)) width_ = 0;
        const std::size_t before = lines_.size();
        if (style.visible) shape(node, name);
        if (lines_.size() > before) {
            if (own("vector-effect") == "non-scaling-stroke" && style.stroked()) losses_.add(SvgLoss::scaled_width);
            count_paints(style);
            if (style.bare())
                lines_.resize(before);
            else if (style.filled())
                fill(before, style);
        }
        children(node, matrix, style, depth);
    }

    void shape(const pugi::xml_node& node, const std::string& name) {
        if (name == "path")
            svg_path(node.attribute("d").value(), source_, curves(), [this](const SvgLine& line) { emit(line); });
        else if (name == "polyline" || name == "polygon")
            emit(svg_points(node.attribute("points").value(), source_, name == "polygon"));
        else if (name == "line")
            emit({{number(node, "x1"), number(node, "y1")}, {number(node, "x2"), number(node, "y2")}});
        else if (name == "rect")
            emit(rectangle_of(node));
        else if (name == "circle")
            emit(svg_ellipse(centre_of(node), Vec2(number(node, "r")), curves()));
        else if (name == "ellipse")
            emit(svg_ellipse(centre_of(node), {number(node, "rx"), number(node, "ry")}, curves()));
    }

    // The lines from `before` on are outlines of one area: lines that fill it come before them where they are
    // drawn themselves, else in their place.
    void fill(std::size_t before, const SvgStyle& style) {
        std::vector<SvgLine> rings;
        for (std::size_t i = before; i < lines_.size(); ++i) rings.push_back(lines_[i].line);
        std::vector<Drawn> area;
        for (AreaLine& line : area_lines(rings, style.rule)) {
            n_points_ += line.line.size() + line.stencil.size();
            area.push_back({std::move(line.line), line.width, line.taper_in, line.taper_out, std::move(line.stencil)});
        }
        if (n_points_ > options_.ink.max_samples) throw Error(source_, "the drawing has too many points");
        if (area.empty()) {  // a line, drawn as such unless it says that it has a stroke, which paints nothing
            if (!style.stroked() && style.stroke.kind != SvgPaint::Kind::none) lines_.resize(before);
            return;
        }
        if (style.fill.kind == SvgPaint::Kind::flat) losses_.add_colour(style.fill.colour);
        if (!style.stroked()) lines_.resize(before);
        lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(before), std::make_move_iterator(area.begin()),
                      std::make_move_iterator(area.end()));
    }

    /// Elements by their `id`, for `use`.
    void index(const pugi::xml_node& node, int depth = 0) {
        if (depth > kDeepest) return;  // `walk` will say so
        if (const auto id = node.attribute("id")) by_id_.emplace(id.value(), node);
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) index(child, depth + 1);
    }

    // Metres per unit of the drawing and the corner that becomes (0, 0).
    SvgMatrix frame(const pugi::xml_node& svg) {
        const double width = length(svg.attribute("width").value()), height = length(svg.attribute("height").value());
        view_ = {width / kPixel, height / kPixel};
        if (const std::string box = svg.attribute("viewBox").value(); !box.empty()) {
            SvgReader in(box, source_);
            const double x = in.number(), y = in.number(), w = in.number();
            if (!(w > 0)) throw Error(source_, "the viewBox has no width");
            const double h = in.number_next() ? in.number() : 0;
            view_ = {w, h};
            const double scale = width > 0 ? width / w : height > 0 && h > 0 ? height / h : kPixel;
            return svg_scaling(scale, scale) * svg_translation(-x, -y);
        }
        return svg_scaling(kPixel, kPixel);
    }

    /// Rules of all style sheets of the file.
    void read_sheets(const pugi::xml_node& node, int depth) {
        if (depth > kDeepest) throw Error(source_, "groups are nested too deeply");
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() != pugi::node_element) continue;
            if (local(child.name()) != "style") {
                read_sheets(child, depth + 1);
                continue;
            }
            std::string sheet;
            for (const pugi::xml_node& text : child.children()) sheet += text.value();
            for (std::size_t passed = sheet_.add(sheet); passed > 0; --passed) losses_.add(SvgLoss::rule);
        }
    }

    const std::vector<Drawn>& lines() const { return lines_; }
    /// What a person would miss, one line each.
    std::vector<Message> left_out() const { return losses_.lines(); }
    static std::string local(const char* name) {
        const char* colon = std::strchr(name, ':');
        return colon ? colon + 1 : name;
    }

  private:
    /// Properties of one element.
    class Properties {
      public:
        Properties(const pugi::xml_node& node, std::map<std::string, std::string> declared)
            : node_(node), declared_(std::move(declared)) {}
        /// "" where nothing says it, or where it is handed down anyway.
        std::string operator()(const char* name) const {
            const auto at = declared_.find(name);
            std::string value = at != declared_.end() ? at->second : node_.attribute(name).value();
            return value == "inherit" ? std::string() : value;
        }
        bool declares(const char* name) const { return declared_.contains(name); }

      private:
        const pugi::xml_node& node_;
        std::map<std::string, std::string> declared_;
    };

    static double opacity(const std::string& text, double otherwise) {
        if (text.empty()) return otherwise;
        const double value = std::strtod(text.c_str(), nullptr) / (text.back() == '%' ? 100 : 1);
        return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
    }

    void inherit(SvgStyle& style, const Properties& own) const {
        if (const std::string paint = own("stroke"); !paint.empty()) style.stroke = svg_paint(paint, by_id_);
        if (const std::string paint = own("fill"); !paint.empty()) style.fill = svg_paint(paint, by_id_);
        if (const std::string width = own("stroke-width"); !width.empty() && width.back() != '%')
            style.width = std::max(0.0, length(width) / kPixel);
        if (const std::string rule = own("fill-rule"); !rule.empty())
            style.rule = rule == "evenodd" ? FillRule::even_odd : FillRule::nonzero;
        if (const std::string seen = own("visibility"); !seen.empty()) style.visible = seen == "visible";
        if (const std::string dashes = own("stroke-dasharray"); !dashes.empty())
            style.dashed = dashes.find_first_of("123456789") != std::string::npos;
        for (const char* marker : {"marker", "marker-start", "marker-mid", "marker-end"})
            if (const std::string value = own(marker); !value.empty()) style.marked = value != "none";
        style.fill_opacity = opacity(own("fill-opacity"), style.fill_opacity);
        style.stroke_opacity = opacity(own("stroke-opacity"), style.stroke_opacity);
    }

    // Elements that leave nothing; whether this is one.
    bool is_lost(const pugi::xml_node& node, const std::string& name) {
        if (name == "foreignObject" && local(node.parent().name()) == "switch")
            return true;  // another child takes its place
        if (name == "foreignObject" || name == "video" || name == "iframe" || name == "canvas")
            losses_.add(SvgLoss::foreign);
        else if (name == "animate" || name == "animateTransform" || name == "animateMotion" || name == "animateColor" ||
                 name == "set")
            losses_.add(SvgLoss::animation);
        else if (name == "script")
            losses_.add(SvgLoss::script);
        else
            return false;
        return true;
    }

    // What an element does to all within it.
    void count_effects(const Properties& own) {
        const auto used = [&](const char* name) {
            const std::string value = own(name);
            return !value.empty() && value != "none" && value != "normal";
        };
        if (used("clip-path")) losses_.add(SvgLoss::clip);
        if (used("mask")) losses_.add(SvgLoss::mask);
        if (used("filter")) losses_.add(SvgLoss::filter);
        if (used("mix-blend-mode")) losses_.add(SvgLoss::blend);
        if (opacity(own("opacity"), 1) < 1) losses_.add(SvgLoss::opacity);
        if (own.declares("transform") && used("transform")) losses_.add(SvgLoss::transform);
    }

    // How the shape just drawn is painted.
    void count_paints(const SvgStyle& style) {
        using Kind = SvgPaint::Kind;
        const auto either = [&](Kind kind) { return style.fill.kind == kind || style.stroke.kind == kind; };
        if (either(Kind::white)) losses_.add(SvgLoss::white);
        if (either(Kind::missing)) losses_.add(SvgLoss::missing_paint);
        if (either(Kind::gradient)) losses_.add(SvgLoss::gradient);
        if (either(Kind::pattern)) losses_.add(SvgLoss::pattern);
        if (style.stroked() && style.dashed) losses_.add(SvgLoss::dash);
        if (style.marked) losses_.add(SvgLoss::marker);
        if ((style.filled() && style.fill_opacity < 1) || (style.stroked() && style.stroke_opacity < 1))
            losses_.add(SvgLoss::opacity);
        if (style.stroked() && style.stroke.kind == Kind::flat) losses_.add_colour(style.stroke.colour);
    }

    void children(const pugi::xml_node& node, const SvgMatrix& matrix, const SvgStyle& style, int depth) {
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) walk(child, matrix, style, depth + 1);
    }
    // Another element drawn here; one that is not in the file draws nothing. A symbol is its children, in the
    // frame of its viewBox.
    void use(const pugi::xml_node& node, SvgMatrix matrix, const SvgStyle& style, int depth) {
        std::string target = node.attribute("href").value();
        if (target.empty()) target = node.attribute("xlink:href").value();
        const bool inside = target.starts_with('#');
        const auto at = inside ? by_id_.find(target.substr(1)) : by_id_.end();
        if (at == by_id_.end())
            return losses_.add(inside || target.empty() ? SvgLoss::missing_use : SvgLoss::outside_use);
        matrix = matrix * svg_translation(number(node, "x"), number(node, "y"));
        if (local(at->second.name()) != "symbol") return walk(at->second, matrix, style, depth + 1);
        if (const std::string box = at->second.attribute("viewBox").value(); !box.empty()) {
            SvgReader in(box, source_);
            const double x = in.number(), y = in.number(), w = in.number(), wanted = number(node, "width");
            const double scale = wanted > 0 && w > 0 ? wanted / w : 1;
            matrix = matrix * svg_scaling(scale, scale) * svg_translation(-x, -y);
        }
        children(at->second, matrix, style, depth + 1);
    }

    // A length with its unit, metres; 0: none, or a part of an unknown page.
    double length(const std::string& text) const {
        if (text.empty() || text.back() == '%') return 0;
        SvgReader in(text, source_);
        const double value = in.number();
        const std::string unit = in.word();
        if (unit == "mm") return value * 1e-3;
        if (unit == "cm") return value * 1e-2;
        if (unit == "in") return value * 0.0254;
        if (unit == "pt") return value * 0.0254 / 72;
        if (unit == "pc") return value * 0.0254 / 6;
        return value * kPixel;
    }
    // In units of the drawing; per cent are of the page.
    double number(const pugi::xml_node& node, const char* name) const {
        const std::string text = node.attribute(name).value();
        if (text.empty()) return 0;
        SvgReader in(text, source_);
        const double value = in.number();
        if (in.peek() == '%') {
            const std::string_view along(name);
            const double page = along == "r" ? glm::length(view_) / std::numbers::sqrt2
                                : along.find('y') != along.npos || along == "height" ? view_.y
                                                                                     : view_.x;
            return value / 100 * page;
        }
        return in.word().empty() ? value : length(text) / kPixel;
    }

    // Of lengths, by the transforms in force.
    double growth() const { return std::sqrt(std::abs(matrix_[0][0] * matrix_[1][1] - matrix_[1][0] * matrix_[0][1])); }
    SvgCurves curves() const { return {.growth = growth(), .tolerance = options_.tolerance}; }
    Vec2 centre_of(const pugi::xml_node& node) const { return {number(node, "cx"), number(node, "cy")}; }
    // A corner without one of its radii has both alike.
    SvgLine rectangle_of(const pugi::xml_node& node) const {
        Vec2 radii(number(node, "rx"), number(node, "ry"));
        if (!node.attribute("rx")) radii.x = radii.y;
        if (!node.attribute("ry")) radii.y = radii.x;
        return svg_rectangle({number(node, "x"), number(node, "y")}, {number(node, "width"), number(node, "height")},
                             radii, curves());
    }
    Vec2 moved(const Vec2& p) const { return Vec2(matrix_ * Vec3(p, 1)); }
    void emit(const SvgLine& line) {
        SvgLine out;
        for (const Vec2& p : line) {
            const Vec2 q = moved(p);
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
        if (n_points_ > options_.ink.max_samples) throw Error(source_, "the drawing has too many points");
        lines_.push_back({std::move(out), width_});
    }

    const std::string& source_;
    const SvgOptions& options_;
    SvgMatrix matrix_{1};
    double width_ = 0;
    SvgSheet sheet_;
    SvgLosses losses_;
    Vec2 view_{0};  // size of the page, units of the drawing
    std::vector<Drawn> lines_;
    std::size_t n_points_ = 0, n_elements_ = 0, n_text_ = 0;
    SvgIds by_id_;
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

}  // namespace

std::vector<stroke::RecordedStroke> parse_svg(std::string_view text, const std::string& source,
                                              const SvgOptions& options) {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text.data(), text.size());
    if (!parsed) throw Error(source, Message("not well formed: {}", xml_fault(parsed)));
    const pugi::xml_node svg = document.document_element();
    if (Drawing::local(svg.name()) != "svg") throw Error(source, "not an SVG drawing");
    Drawing drawing(source, options);
    drawing.index(svg);
    drawing.read_sheets(svg, 0);
    drawing.walk(svg, drawing.frame(svg), {}, 0);
    const std::vector<Message> losses = drawing.left_out();
    if (drawing.lines().empty())
        throw Error(source, Message("nothing is drawn in this file; {}",
                                    losses.empty() ? Message("text must be turned into paths first") : losses.front()));
    if (options.ink.note)
        for (const Message& loss : losses) options.ink.note(loss);
    std::ostringstream ink;
    ink.precision(12);
    ink << "<ink xmlns='http://www.w3.org/2003/InkML'>";
    for (const Drawn& drawn : drawing.lines()) {
        const SvgLine& line = drawn.line;
        ink << "<trace>";
        for (std::size_t i = 0; i < line.size(); ++i)
            ink << (i ? "," : "") << 1e3 * line[i].x << ' ' << 1e3 * line[i].y;
        ink << "</trace>";
    }
    ink << "</ink>";
    std::vector<stroke::RecordedStroke> traces = parse_inkml(ink.str(), source, options.ink);
    for (std::size_t i = 0; i < traces.size(); ++i) {
        give_width(traces[i], drawing.lines().at(i), options.ink.flat_pressure);
        traces[i].stencil = drawing.lines().at(i).stencil;
    }
    return traces;
}

std::vector<stroke::RecordedStroke> read_svg(const std::filesystem::path& path, const SvgOptions& options) {
    const std::vector<char> bytes = read_file(path, options.ink.max_bytes);
    return parse_svg({bytes.data(), bytes.size()}, path.string(), options);
}

std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const InkmlOptions& options) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".svg" ? read_svg(path, {.ink = options}) : read_inkml(path, options);
}

}  // namespace tuft::io
