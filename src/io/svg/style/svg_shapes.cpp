#include "io/svg/style/svg_shapes.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/error.h"

namespace tuft::io {

void SvgReader::skip() {
    while (at_ < end_ && (std::isspace(static_cast<unsigned char>(*at_)) || *at_ == ',')) ++at_;
}

bool SvgReader::number_next() {
    const char c = peek();
    return c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9');
}

double SvgReader::number() {
    skip();
    if (at_ < end_ && *at_ == '+') ++at_;
    double value = 0;
    const auto [next, fault] = std::from_chars(at_, end_, value);
    if (fault != std::errc() || !std::isfinite(value) || std::abs(value) > 1e9)
        throw Error(source_,
                    Message("'{}' is not a number of a drawing",
                            std::string(at_, std::min<std::size_t>(12, static_cast<std::size_t>(end_ - at_)))));
    at_ = next;
    return value;
}

bool SvgReader::flag() {
    const char c = peek();
    if (c != '0' && c != '1') throw Error(source_, "an arc's flag is neither 0 nor 1");
    ++at_;
    return c == '1';
}

std::string SvgReader::word() {
    skip();
    const char* start = at_;
    while (at_ < end_ && std::isalpha(static_cast<unsigned char>(*at_))) ++at_;
    return {start, at_};
}

SvgMatrix svg_translation(double x, double y) {
    return {1, 0, 0, 0, 1, 0, x, y, 1};
}
SvgMatrix svg_scaling(double x, double y) {
    return {x, 0, 0, 0, y, 0, 0, 0, 1};
}

SvgMatrix svg_transform(const char* text, const std::string& source) {
    SvgReader in(text, source);
    SvgMatrix m(1);
    while (!in.done()) {
        const std::string name = in.word();
        if (in.peek() != '(') throw Error(source, Message("'{}' is not a transform", name));
        in.take();
        std::vector<double> v;
        while (in.number_next()) v.push_back(in.number());
        if (in.peek() != ')') throw Error(source, "a transform is not closed");
        in.take();
        const auto at = [&](std::size_t i, double otherwise = 0) { return i < v.size() ? v[i] : otherwise; };
        if (name == "matrix" && v.size() == 6)
            m = m * SvgMatrix(v[0], v[1], 0, v[2], v[3], 0, v[4], v[5], 1);
        else if (name == "translate")
            m = m * svg_translation(at(0), at(1));
        else if (name == "scale")
            m = m * svg_scaling(at(0, 1), at(1, at(0, 1)));
        else if (name == "rotate") {
            const double a = at(0) * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
            m = m * svg_translation(at(1), at(2)) * SvgMatrix(c, s, 0, -s, c, 0, 0, 0, 1) *
                svg_translation(-at(1), -at(2));
        } else if (name == "skewX")
            m = m * SvgMatrix(1, 0, 0, std::tan(at(0) * std::numbers::pi / 180), 1, 0, 0, 0, 1);
        else if (name == "skewY")
            m = m * SvgMatrix(1, std::tan(at(0) * std::numbers::pi / 180), 0, 0, 1, 0, 0, 0, 1);
        else
            throw Error(source, Message("'{}' is not a transform", name));
    }
    return m;
}

namespace {

// Chords of a curve over t in (0, 1]; `bend` bounds the length of its second derivative in user units.
template <class Curve>
void chords(SvgLine& line, double bend, const SvgCurves& of, const Curve& curve) {
    // A chord over a step h leaves a curve by at most h² |c''| / 8.
    const double steps = std::ceil(std::sqrt(bend * of.growth / (8 * of.tolerance)));
    const int n = static_cast<int>(std::clamp(steps, 1.0, static_cast<double>(SvgCurves::kMost)));
    for (int i = 1; i <= n; ++i) line.push_back(curve(static_cast<double>(i) / n));
}
}  // namespace

void SvgCurves::cubic(SvgLine& line, const Vec2& b, const Vec2& c, const Vec2& d) const {
    const Vec2 a = line.back();
    chords(line, 6 * std::max(glm::length(a - 2.0 * b + c), glm::length(b - 2.0 * c + d)), *this, [&](double t) {
        const double u = 1 - t;
        return u * u * u * a + 3 * u * u * t * b + 3 * u * t * t * c + t * t * t * d;
    });
}

// Appendix F.6.5: from end points to centre and angles.
void SvgCurves::arc(SvgLine& line, const SvgArc& arc) const {
    const auto [radii, turn, large, sweep, end] = arc;
    const Vec2 start = line.back();
    double rx = std::abs(radii.x), ry = std::abs(radii.y);
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
    double sweep_angle = std::atan2((-p.y - q.y) / ry, (-p.x - q.x) / rx) - from;
    if (sweep && sweep_angle < 0) sweep_angle += 2 * std::numbers::pi;
    if (!sweep && sweep_angle > 0) sweep_angle -= 2 * std::numbers::pi;
    chords(line, std::max(rx, ry) * sweep_angle * sweep_angle, *this, [&](double t) {
        const double a = from + t * sweep_angle, x = rx * std::cos(a), y = ry * std::sin(a);
        return Vec2(c * x - s * y, s * x + c * y) + centre;
    });
    line.back() = end;
}

namespace {

/// Path data as subpaths: the current point and what the next command needs of the one before (SVG 1.1, 8.3).
class PathReader {
  public:
    PathReader(SvgReader& in, const SvgCurves& curves, const std::function<void(const SvgLine&)>& emit)
        : in_(in), curves_(curves), emit_(emit) {}

    /// Reads the points of one command; `command` is a lower-case letter where they are relative.
    void read(char command) {
        const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
        base_ = c == command ? Vec2(0) : at_;
        if (c == 'M') {
            flush();
            start_ = at_ = point();
        } else {
            if (line_.empty()) line_.push_back(at_);
            add(c);
        }
        before_ = c;
    }
    void flush() {
        emit_(line_);
        line_.clear();
    }

  private:
    Vec2 point() {
        const double x = in_.number();
        return base_ + Vec2(x, in_.number());
    }
    /// The reflected control point after a curve of the same kind, else the current point.
    Vec2 smooth(const char* kinds) const { return std::strchr(kinds, before_) && before_ ? 2.0 * at_ - control_ : at_; }

    void add(char c) {
        switch (c) {
            case 'L':
                line_.push_back(point());
                break;
            case 'H':
                line_.emplace_back(base_.x + in_.number(), at_.y);
                break;
            case 'V':
                line_.emplace_back(at_.x, base_.y + in_.number());
                break;
            case 'C':
            case 'S': {
                const Vec2 first = c == 'C' ? point() : smooth("CS");
                control_ = point();
                curves_.cubic(line_, first, control_, point());
                break;
            }
            case 'Q':
            case 'T': {
                control_ = c == 'Q' ? point() : smooth("QT");
                const Vec2 end = point();
                curves_.cubic(line_, at_ + 2.0 / 3 * (control_ - at_), end + 2.0 / 3 * (control_ - end), end);
                break;
            }
            case 'A': {
                const double rx = in_.number(), ry = in_.number(), turn = in_.number() * std::numbers::pi / 180;
                const bool large = in_.flag(), sweep = in_.flag();
                curves_.arc(line_, {{rx, ry}, turn, large, sweep, point()});
                break;
            }
            default:  // Z
                line_.push_back(start_);
                flush();
                at_ = start_;
                return;
        }
        at_ = line_.back();
    }

    SvgReader& in_;
    const SvgCurves& curves_;
    const std::function<void(const SvgLine&)>& emit_;
    SvgLine line_;
    Vec2 start_{0}, at_{0}, control_{0}, base_{0};
    char before_ = '\0';
};

}  // namespace

void svg_path(const char* text, const std::string& source, const SvgCurves& curves,
              const std::function<void(const SvgLine&)>& emit) {
    SvgReader in(text, source);
    PathReader path(in, curves, emit);
    char command = '\0';
    try {
        while (!in.done()) {
            if (std::isalpha(static_cast<unsigned char>(in.peek()))) {
                command = in.take();
                if (!std::strchr("MmLlHhVvCcSsQqTtAaZz", command))
                    throw Error(source, Message("a path has the unknown command '{}'", command));
            } else if (!in.number_next() || command == '\0' || command == 'Z' || command == 'z') {
                throw Error(source, "a path cannot be read");
            }
            path.read(command);
            if (command == 'M') command = 'L';  // more points are lines
            if (command == 'm') command = 'l';
        }
    } catch (const Error&) {
        path.flush();
        throw;
    }
    path.flush();
}

std::vector<std::pair<Vec2, double>> svg_vertices(const std::vector<SvgLine>& lines) {
    std::vector<std::pair<Vec2, double>> out;
    const auto unit = [](const Vec2& d) { return glm::length(d) > 0 ? glm::normalize(d) : Vec2(0); };
    for (const SvgLine& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i) {
            const Vec2 in = i > 0 ? line[i] - line[i - 1] : Vec2(0),
                       on = i + 1 < line.size() ? line[i + 1] - line[i] : Vec2(0);
            const Vec2 middle = unit(in) + unit(on);
            out.emplace_back(line[i], std::atan2(middle.y, middle.x));
        }
    return out;
}

SvgLine svg_points(const char* text, const std::string& source, bool closed) {
    SvgReader in(text, source);
    SvgLine line;
    while (in.number_next()) {
        const double x = in.number();
        line.emplace_back(x, in.number());
    }
    if (closed && !line.empty()) line.push_back(line.front());
    return line;
}

SvgLine svg_rectangle(const Vec2& corner, const Vec2& size, const Vec2& radii, const SvgCurves& curves) {
    const double x = corner.x, y = corner.y, w = size.x, h = size.y;
    if (!(w > 0 && h > 0)) return {};
    const double rx = std::clamp(radii.x, 0.0, 0.5 * w), ry = std::clamp(radii.y, 0.0, 0.5 * h);
    if (rx <= 0 || ry <= 0) return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}, {x, y}};
    SvgLine line{{x + rx, y}, {x + w - rx, y}};
    const auto round = [&](const Vec2& end) { curves.arc(line, {.radii = {rx, ry}, .sweep = true, .end = end}); };
    round({x + w, y + ry}), line.emplace_back(x + w, y + h - ry);
    round({x + w - rx, y + h}), line.emplace_back(x + rx, y + h);
    round({x, y + h - ry}), line.emplace_back(x, y + ry);
    round({x + rx, y});
    return line;
}

SvgLine svg_ellipse(const Vec2& centre, const Vec2& radii, const SvgCurves& curves) {
    if (!(radii.x > 0 && radii.y > 0)) return {};
    SvgLine line{{centre.x + radii.x, centre.y}};
    curves.arc(line, {.radii = radii, .sweep = true, .end = {centre.x - radii.x, centre.y}});
    curves.arc(line, {.radii = radii, .sweep = true, .end = {centre.x + radii.x, centre.y}});
    return line;
}

}  // namespace tuft::io
