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
#include "io/strokes/area_lines.h"
#include "io/strokes/svg_losses.h"
#include "io/strokes/svg_style.h"

namespace tuft::io {
namespace {

constexpr double kPixel = 0.0254 / 96;                   // metres of a CSS pixel
constexpr double kSpacing = 5e-4;                        // metres, of samples on a straight line
constexpr int kDeepest = 64;                             // of nested groups
constexpr std::size_t kMostElements = 1'000'000;         // drawn, each `use` of one counted
constexpr std::size_t kMostText = std::size_t{1} << 30;  // bytes of attributes read, those of each `use` counted
constexpr int kMostChords = 4096;                        // of one curve
using Matrix = glm::dmat3;
using Line = std::vector<Vec2>;

// A line of the drawing; metres.
struct Drawn {
    Line line;
    double width = 0;           // of its stroke; 0: it has none
    double head = 0, tail = 0;  // lengths over which it runs out into a point
    std::vector<stroke::StencilEdge> stencil = {};
};

// Reads numbers, flags and words from an attribute.
class Reader {
  public:
    Reader(std::string_view text, const std::string& source)
        : at_(text.data()), end_(at_ + text.size()), source_(source) {}

    void skip() {
        while (at_ < end_ && (std::isspace(static_cast<unsigned char>(*at_)) || *at_ == ',')) ++at_;
    }
    bool done() { return skip(), at_ == end_; }
    char peek() { return skip(), at_ < end_ ? *at_ : '\0'; }
    char take() { return *at_++; }
    bool number_next() {
        const char c = peek();
        return c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9');
    }
    double number() {
        skip();
        if (at_ < end_ && *at_ == '+') ++at_;
        double value = 0;
        const auto [next, fault] = std::from_chars(at_, end_, value);
        if (fault != std::errc() || !std::isfinite(value) || std::abs(value) > 1e9)
            throw Error(source_, "'" +
                                     std::string(at_, std::min<std::size_t>(12, static_cast<std::size_t>(end_ - at_))) +
                                     "' is not a number of a drawing");
        at_ = next;
        return value;
    }
    bool flag() {
        const char c = peek();
        if (c != '0' && c != '1') throw Error(source_, "an arc's flag is neither 0 nor 1");
        ++at_;
        return c == '1';
    }
    std::string word() {
        skip();
        const char* start = at_;
        while (at_ < end_ && std::isalpha(static_cast<unsigned char>(*at_))) ++at_;
        return {start, at_};
    }

  private:
    const char *at_, *end_;
    const std::string& source_;
};

Matrix translation(double x, double y) {
    return {1, 0, 0, 0, 1, 0, x, y, 1};
}
Matrix scaling(double x, double y) {
    return {x, 0, 0, 0, y, 0, 0, 0, 1};
}

class Drawing {
  public:
    Drawing(const std::string& source, const SvgOptions& options) : source_(source), options_(options) {}

    void walk(const pugi::xml_node& node, Matrix matrix, SvgStyle style, int depth) {
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
        if (const auto transform = node.attribute("transform")) matrix = matrix * transform_of(transform.value());
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
            path(node.attribute("d").value());
        else if (name == "polyline" || name == "polygon")
            points(node.attribute("points").value(), name == "polygon");
        else if (name == "line")
            emit({{number(node, "x1"), number(node, "y1")}, {number(node, "x2"), number(node, "y2")}});
        else if (name == "rect")
            rectangle(node);
        else if (name == "circle")
            ellipse(number(node, "cx"), number(node, "cy"), number(node, "r"), number(node, "r"));
        else if (name == "ellipse")
            ellipse(number(node, "cx"), number(node, "cy"), number(node, "rx"), number(node, "ry"));
    }

    // The lines from `before` on are outlines of one area: lines that fill it come before them where they are
    // drawn themselves, else in their place.
    void fill(std::size_t before, const SvgStyle& style) {
        std::vector<Line> rings;
        for (std::size_t i = before; i < lines_.size(); ++i) rings.push_back(lines_[i].line);
        std::vector<Drawn> area;
        for (AreaLine& line : area_lines(rings, style.rule)) {
            n_points_ += line.line.size() + line.stencil.size();
            area.push_back({std::move(line.line), line.width, line.head, line.tail, std::move(line.stencil)});
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
    Matrix frame(const pugi::xml_node& svg) {
        const double width = length(svg.attribute("width").value()), height = length(svg.attribute("height").value());
        view_ = {width / kPixel, height / kPixel};
        if (const std::string box = svg.attribute("viewBox").value(); !box.empty()) {
            Reader in(box, source_);
            const double x = in.number(), y = in.number(), w = in.number();
            if (!(w > 0)) throw Error(source_, "the viewBox has no width");
            const double h = in.number_next() ? in.number() : 0;
            view_ = {w, h};
            const double scale = width > 0 ? width / w : height > 0 && h > 0 ? height / h : kPixel;
            return scaling(scale, scale) * translation(-x, -y);
        }
        return scaling(kPixel, kPixel);
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
    std::vector<std::string> left_out() const { return losses_.lines(); }
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

    void children(const pugi::xml_node& node, const Matrix& matrix, const SvgStyle& style, int depth) {
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) walk(child, matrix, style, depth + 1);
    }
    // Another element drawn here; one that is not in the file draws nothing. A symbol is its children, in the
    // frame of its viewBox.
    void use(const pugi::xml_node& node, Matrix matrix, const SvgStyle& style, int depth) {
        std::string target = node.attribute("href").value();
        if (target.empty()) target = node.attribute("xlink:href").value();
        const bool inside = target.starts_with('#');
        const auto at = inside ? by_id_.find(target.substr(1)) : by_id_.end();
        if (at == by_id_.end())
            return losses_.add(inside || target.empty() ? SvgLoss::missing_use : SvgLoss::outside_use);
        matrix = matrix * translation(number(node, "x"), number(node, "y"));
        if (local(at->second.name()) != "symbol") return walk(at->second, matrix, style, depth + 1);
        if (const std::string box = at->second.attribute("viewBox").value(); !box.empty()) {
            Reader in(box, source_);
            const double x = in.number(), y = in.number(), w = in.number(), wanted = number(node, "width");
            const double scale = wanted > 0 && w > 0 ? wanted / w : 1;
            matrix = matrix * scaling(scale, scale) * translation(-x, -y);
        }
        children(at->second, matrix, style, depth + 1);
    }

    // A length with its unit, metres; 0: none, or a part of an unknown page.
    double length(const std::string& text) const {
        if (text.empty() || text.back() == '%') return 0;
        Reader in(text, source_);
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
        Reader in(text, source_);
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

    Matrix transform_of(const char* text) const {
        Reader in(text, source_);
        Matrix m(1);
        while (!in.done()) {
            const std::string name = in.word();
            if (in.peek() != '(') throw Error(source_, "'" + name + "' is not a transform");
            in.take();
            std::vector<double> v;
            while (in.number_next()) v.push_back(in.number());
            if (in.peek() != ')') throw Error(source_, "a transform is not closed");
            in.take();
            const auto at = [&](std::size_t i, double otherwise = 0) { return i < v.size() ? v[i] : otherwise; };
            if (name == "matrix" && v.size() == 6)
                m = m * Matrix(v[0], v[1], 0, v[2], v[3], 0, v[4], v[5], 1);
            else if (name == "translate")
                m = m * translation(at(0), at(1));
            else if (name == "scale")
                m = m * scaling(at(0, 1), at(1, at(0, 1)));
            else if (name == "rotate") {
                const double a = at(0) * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
                m = m * translation(at(1), at(2)) * Matrix(c, s, 0, -s, c, 0, 0, 0, 1) * translation(-at(1), -at(2));
            } else if (name == "skewX")
                m = m * Matrix(1, 0, 0, std::tan(at(0) * std::numbers::pi / 180), 1, 0, 0, 0, 1);
            else if (name == "skewY")
                m = m * Matrix(1, std::tan(at(0) * std::numbers::pi / 180), 0, 0, 1, 0, 0, 0, 1);
            else
                throw Error(source_, "'" + name + "' is not a transform");
        }
        return m;
    }

    // Of lengths, by the transforms in force.
    double growth() const { return std::sqrt(std::abs(matrix_[0][0] * matrix_[1][1] - matrix_[1][0] * matrix_[0][1])); }
    Vec2 moved(const Vec2& p) const { return Vec2(matrix_ * Vec3(p, 1)); }
    void emit(const Line& line) {
        Line out;
        for (const Vec2& p : line) {
            const Vec2 q = moved(p);
            if (!(std::abs(q.x) < options_.ink.max_extent && std::abs(q.y) < options_.ink.max_extent))
                throw Error(source_, "the drawing is absurdly large");
            // Pressure is laid out along the samples, so long chords need some.
            const int n = out.empty() ? 1
                                      : static_cast<int>(std::clamp(glm::distance(out.back(), q) / kSpacing, 1.0,
                                                                    static_cast<double>(kMostChords)));
            const Vec2 from = out.empty() ? q : out.back();
            if (!out.empty() && q == from) continue;
            for (int i = 1; i <= n; ++i) out.push_back(glm::mix(from, q, static_cast<double>(i) / n));
        }
        if (out.size() < 2) return;
        n_points_ += out.size();
        if (n_points_ > options_.ink.max_samples) throw Error(source_, "the drawing has too many points");
        lines_.push_back({std::move(out), width_});
    }

    // Chords of a curve over t in (0, 1]; `bend` bounds the length of its second derivative in user units.
    template <class Curve>
    void chords(Line& line, double bend, const Curve& curve) const {
        // A chord over a step h leaves a curve by at most h² |c''| / 8.
        const double steps = std::ceil(std::sqrt(bend * growth() / (8 * options_.tolerance)));
        const int n = static_cast<int>(std::clamp(steps, 1.0, static_cast<double>(kMostChords)));
        for (int i = 1; i <= n; ++i) line.push_back(curve(static_cast<double>(i) / n));
    }
    void cubic(Line& line, const Vec2& b, const Vec2& c, const Vec2& d) const {
        const Vec2 a = line.back();
        chords(line, 6 * std::max(glm::length(a - 2.0 * b + c), glm::length(b - 2.0 * c + d)), [&](double t) {
            const double u = 1 - t;
            return u * u * u * a + 3 * u * u * t * b + 3 * u * t * t * c + t * t * t * d;
        });
    }
    // Appendix F.6.5: from end points to centre and angles.
    void arc(Line& line, double rx, double ry, double turn, bool large, bool sweep, const Vec2& end) const {
        const Vec2 start = line.back();
        rx = std::abs(rx), ry = std::abs(ry);
        if (rx == 0 || ry == 0 || start == end) return line.push_back(end);
        const double c = std::cos(turn), s = std::sin(turn);
        const Vec2 h = 0.5 * (start - end), p(c * h.x + s * h.y, -s * h.x + c * h.y);
        if (const double over = p.x * p.x / (rx * rx) + p.y * p.y / (ry * ry); over > 1)
            rx *= std::sqrt(over), ry *= std::sqrt(over);
        const double below = rx * rx * p.y * p.y + ry * ry * p.x * p.x;
        const double root = (large == sweep ? -1 : 1) * std::sqrt(std::max(0.0, (rx * rx * ry * ry - below) / below));
        const Vec2 q(root * rx * p.y / ry, -root * ry * p.x / rx);
        const Vec2 centre = Vec2(c * q.x - s * q.y, s * q.x + c * q.y) + 0.5 * (start + end);
        const double from = std::atan2((p.y - q.y) / ry, (p.x - q.x) / rx);
        double way = std::atan2((-p.y - q.y) / ry, (-p.x - q.x) / rx) - from;
        if (sweep && way < 0) way += 2 * std::numbers::pi;
        if (!sweep && way > 0) way -= 2 * std::numbers::pi;
        chords(line, std::max(rx, ry) * way * way, [&](double t) {
            const double a = from + t * way, x = rx * std::cos(a), y = ry * std::sin(a);
            return Vec2(c * x - s * y, s * x + c * y) + centre;
        });
        line.back() = end;
    }

    void points(const char* text, bool closed) {
        Reader in(text, source_);
        Line line;
        while (in.number_next()) {
            const double x = in.number();
            line.emplace_back(x, in.number());
        }
        if (closed && !line.empty()) line.push_back(line.front());
        emit(line);
    }
    void rectangle(const pugi::xml_node& node) {
        const double x = number(node, "x"), y = number(node, "y"), w = number(node, "width"),
                     h = number(node, "height");
        if (!(w > 0 && h > 0)) return;
        // A corner without one of its radii has both alike.
        double rx = number(node, "rx"), ry = number(node, "ry");
        if (!node.attribute("rx")) rx = ry;
        if (!node.attribute("ry")) ry = rx;
        rx = std::clamp(rx, 0.0, 0.5 * w), ry = std::clamp(ry, 0.0, 0.5 * h);
        if (rx <= 0 || ry <= 0) return emit({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}, {x, y}});
        Line line{{x + rx, y}, {x + w - rx, y}};
        const auto corner = [&](const Vec2& end) { arc(line, rx, ry, 0, false, true, end); };
        corner({x + w, y + ry}), line.emplace_back(x + w, y + h - ry);
        corner({x + w - rx, y + h}), line.emplace_back(x + rx, y + h);
        corner({x, y + h - ry}), line.emplace_back(x, y + ry);
        corner({x + rx, y});
        emit(line);
    }
    void ellipse(double x, double y, double rx, double ry) {
        if (!(rx > 0 && ry > 0)) return;
        Line line{{x + rx, y}};
        arc(line, rx, ry, 0, false, true, {x - rx, y});
        arc(line, rx, ry, 0, false, true, {x + rx, y});
        emit(line);
    }

    void path(const char* text) {
        Reader in(text, source_);
        Line line;
        Vec2 start(0), at(0), control(0);
        char command = '\0', before = '\0';
        const auto flush = [&] {
            emit(line);
            line.clear();
        };
        while (!in.done()) {
            if (std::isalpha(static_cast<unsigned char>(in.peek())))
                command = in.take();
            else if (!in.number_next() || command == '\0' || command == 'Z' || command == 'z')
                throw Error(source_, "a path cannot be read");
            const bool relative = std::islower(static_cast<unsigned char>(command)) != 0;
            const Vec2 base = relative ? at : Vec2(0);
            const auto point = [&] {
                const double x = in.number();
                return base + Vec2(x, in.number());
            };
            const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
            if (c == 'M') {
                flush();
                start = at = point();
                command = relative ? 'l' : 'L';  // more points are lines
                before = 'M';
                continue;
            }
            if (line.empty()) line.push_back(at);
            // The reflected control point after a curve of the same kind, else the current point.
            const auto smooth = [&](const char* kinds) {
                return std::strchr(kinds, before) && before ? 2.0 * at - control : at;
            };
            switch (c) {
                case 'L':
                    line.push_back(point());
                    break;
                case 'H':
                    line.emplace_back(base.x + in.number(), at.y);
                    break;
                case 'V':
                    line.emplace_back(at.x, base.y + in.number());
                    break;
                case 'C':
                case 'S': {
                    const Vec2 first = c == 'C' ? point() : smooth("CS");
                    control = point();
                    cubic(line, first, control, point());
                    break;
                }
                case 'Q':
                case 'T': {
                    control = c == 'Q' ? point() : smooth("QT");
                    const Vec2 end = point();
                    cubic(line, at + 2.0 / 3 * (control - at), end + 2.0 / 3 * (control - end), end);
                    break;
                }
                case 'A': {
                    const double rx = in.number(), ry = in.number(), turn = in.number() * std::numbers::pi / 180;
                    const bool large = in.flag(), sweep = in.flag();
                    arc(line, rx, ry, turn, large, sweep, point());
                    break;
                }
                case 'Z':
                    line.push_back(start);
                    flush();
                    at = start;
                    before = 'Z';
                    continue;
                default:
                    throw Error(source_, std::string("a path has the unknown command '") + command + "'");
            }
            at = line.back();
            before = c;
        }
        flush();
    }

    const std::string& source_;
    const SvgOptions& options_;
    Matrix matrix_{1};
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
        const double in = drawn.head > 0 ? std::min(1.0, kFuller * along / drawn.head) : 1,
                     out = drawn.tail > 0 ? std::min(1.0, kFuller * (whole - along) / drawn.tail) : 1;
        trace.samples[i].pressure = full * std::clamp(std::min(in, out), 0.0, 1.0);
    }
}

}  // namespace

std::vector<stroke::RecordedStroke> parse_svg(std::string_view text, const std::string& source,
                                              const SvgOptions& options) {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text.data(), text.size());
    if (!parsed) throw Error(source, std::string("not well formed: ") + parsed.description());
    const pugi::xml_node svg = document.document_element();
    if (Drawing::local(svg.name()) != "svg") throw Error(source, "not an SVG drawing");
    Drawing drawing(source, options);
    drawing.index(svg);
    drawing.read_sheets(svg, 0);
    drawing.walk(svg, drawing.frame(svg), {}, 0);
    const std::vector<std::string> losses = drawing.left_out();
    if (drawing.lines().empty())
        throw Error(source, "nothing is drawn in this file; " +
                                (losses.empty() ? "text must be turned into paths first" : losses.front()));
    if (options.ink.note)
        for (const std::string& loss : losses) options.ink.note(source + ": " + loss);
    std::ostringstream ink;
    ink.precision(12);
    ink << "<ink xmlns='http://www.w3.org/2003/InkML'>";
    for (const Drawn& drawn : drawing.lines()) {
        const Line& line = drawn.line;
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
