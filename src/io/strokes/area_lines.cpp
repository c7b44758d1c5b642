#include "io/strokes/area_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/segment.h"
#include "core/system/interrupt.h"

namespace tuft::io {

namespace {

using Line = std::vector<Vec2>;

constexpr double kStem = 0.36, kCompact = 0.06;  // line's width: of a stem's, of the area's root

// Widths of the line.
constexpr double kFirst = 0.22;            // from the outline to the first line; bends draw the ink inwards
constexpr double kNext = 0.33;             // from one line to the next
constexpr double kChord = 0.1;             // of edges, and between points
constexpr double kSlack = 0.02;            // that the outline which lines follow leaves the true one
constexpr double kBare = 1;                // from the outline to the next line, where it counts as bare
constexpr double kPoint = 0.4;             // within which a line turns at a point
constexpr double kPast = 0.5;              // that it goes on past the corner, on the stencil edge
constexpr double kBetween = 1.75;          // and between others, where it begins thin
constexpr double kSmall = 8;               // shorter loops get a dab in their middle, than half of it are one
constexpr double kShort = 0.5, kFine = 4;  // shorter pieces are none; of finer lines
constexpr int kLevels = 4;

/// Points within a radius, found by the squares of a grid as wide.
class Near {
  public:
    Near(double radius, const std::vector<Vec2>& points) : radius_(radius) {
        for (const Vec2& p : points) points_.push_back({key(square(p.x), square(p.y)), p});
        std::sort(points_.begin(), points_.end(), [](const Placed& a, const Placed& b) { return a.key < b.key; });
    }
    template <class Test>
    bool any(const Vec2& p, Test test) const {
        const std::int64_t x = square(p.x), y = square(p.y);
        for (std::int64_t j = -1; j <= 1; ++j)
            for (std::int64_t i = -1; i <= 1; ++i) {
                const std::uint64_t wanted = key(x + i, y + j);
                auto at = std::lower_bound(points_.begin(), points_.end(), wanted,
                                           [](const Placed& a, std::uint64_t b) { return a.key < b; });
                for (; at != points_.end() && at->key == wanted; ++at)
                    if (test(at->p)) return true;
            }
        return false;
    }

  private:
    struct Placed {
        std::uint64_t key;
        Vec2 p;
    };
    std::int64_t square(double x) const { return static_cast<std::int64_t>(std::floor(x / radius_)); }
    static std::uint64_t key(std::int64_t i, std::int64_t j) {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15u ^
               static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Fu;
    }
    double radius_;
    std::vector<Placed> points_;  // by the key of their square
};

/// Of the outline; the area is on its left.
struct Edge {
    Vec2 from, to;
    bool open = true;  ///< not covered yet
    Vec2 middle() const { return 0.5 * (from + to); }
};

/// The rings as short edges.
std::vector<std::vector<Edge>> border_of(const Shape& shape, double chord) {
    std::vector<std::vector<Edge>> border;
    for (const Ring& ring : shape.rings()) {
        std::vector<Edge> edges;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            const auto n = static_cast<int>(std::ceil(glm::distance(a, b) / chord));
            for (int k = 0; k < n; ++k)
                edges.push_back({glm::mix(a, b, double(k) / n), glm::mix(a, b, double(k + 1) / n)});
        }
        border.push_back(std::move(edges));
    }
    return border;
}

constexpr double kStencilReach = 3;  // widths from a line within which the outline is masked

std::vector<stroke::StencilEdge> stencil_of(const Shape& shape) {
    std::vector<stroke::StencilEdge> stencil;
    for (const Ring& ring : shape.rings())
        for (std::size_t i = 0; i < ring.size(); ++i)
            stencil.push_back({ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]});
    return stencil;
}

/// The points of a line in runs, each within a circle, and the runs in twos within larger ones: whether any lies near
/// an edge takes the logarithm of their number.
class PointRuns {
  public:
    explicit PointRuns(const Line& points) : points_(points), last_level_(1) {
        while (last_level_ * kRun < points.size()) last_level_ *= 2;
        circles_.resize(2 * last_level_);
        for (std::size_t k = 2 * last_level_ - 1; k > 0; --k) circles_[k] = circle_of(k);
    }

    bool any_within(const stroke::StencilEdge& e, double reach) const { return any_within(1, e, reach); }

  private:
    static constexpr std::size_t kRun = 8;
    struct Circle {
        Vec2 centre{0};
        double radius = -1;  ///< below 0: without points
    };

    Circle circle_of(std::size_t k) const {
        if (k < last_level_) {
            const Circle &a = circles_[2 * k], &b = circles_[2 * k + 1];
            if (b.radius < 0) return a;
            const Vec2 centre = 0.5 * (a.centre + b.centre);
            return {centre, 0.5 * glm::distance(a.centre, b.centre) + std::max(a.radius, b.radius)};
        }
        const std::size_t from = (k - last_level_) * kRun, to = std::min(from + kRun, points_.size());
        if (from >= to) return {};
        Circle circle{0.5 * (points_[from] + points_[to - 1]), 0};
        for (std::size_t i = from; i < to; ++i)
            circle.radius = std::max(circle.radius, glm::distance(circle.centre, points_[i]));
        return circle;
    }

    bool any_within(std::size_t k, const stroke::StencilEdge& e, double reach) const {
        constexpr double kRounding = 1 + 1e-9;  // of the distances, some 1e-16 of coordinates each
        const Circle& circle = circles_[k];
        if (circle.radius < 0 || segment_distance(e.from, e.to, circle.centre) > kRounding * (reach + circle.radius))
            return false;
        if (k < last_level_) return any_within(2 * k, e, reach) || any_within(2 * k + 1, e, reach);
        const std::size_t from = (k - last_level_) * kRun, to = std::min(from + kRun, points_.size());
        for (std::size_t i = from; i < to; ++i)
            if (segment_distance(e.from, e.to, points_[i]) < reach) return true;
        return false;
    }

    const Line& points_;
    std::size_t last_level_;  // index of the first run's circle; those of circles k are 2 k and 2 k + 1
    std::vector<Circle> circles_;
};

/// Gives each line the stencil edge beside it.
void attach_stencils(const std::vector<stroke::StencilEdge>& stencil, std::vector<AreaLine>& lines) {
    for (AreaLine& line : lines) {
        check_interrupt();
        const double reach = kStencilReach * line.width;
        const PointRuns points(line.line);
        for (const stroke::StencilEdge& e : stencil)
            if (points.any_within(e, reach)) line.stencil.push_back(e);
    }
}

/// Points at even steps of about `step` along a path; its end is left out.
Line even(std::span<const Vec2> path, double step) {
    double whole = 0;
    for (std::size_t i = 1; i < path.size(); ++i) whole += glm::distance(path[i - 1], path[i]);
    const auto n = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(whole / step)));
    Line points;
    double along = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double length = glm::distance(path[i - 1], path[i]);
        for (double at; points.size() < n && (at = whole * double(points.size()) / double(n)) < along + length;)
            points.push_back(glm::mix(path[i - 1], path[i], (at - along) / length));
        along += length;
    }
    return points;
}

/// Means of points beside each other, up to `reach` to both sides, by a Gauss curve; fewer towards
/// the ends of a line that is open, which stay.
Line means(const Line& line, std::ptrdiff_t reach, bool closed) {
    const auto n = static_cast<std::ptrdiff_t>(line.size());
    std::vector<double> curve;  // its weights of neighbours; of all points but those at open ends the same
    Line out;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        const std::ptrdiff_t m = closed ? std::min(reach, n / 2) : std::min({reach, i, n - 1 - i});
        if (static_cast<std::ptrdiff_t>(curve.size()) != m) {
            curve.clear();
            for (std::ptrdiff_t k = 1; k <= m; ++k) {
                const double x = 2.5 * double(k) / double(m);
                curve.push_back(std::exp(-0.5 * x * x));
            }
        }
        Vec2 sum = line[static_cast<std::size_t>(i)];
        double weights = 1;
        for (std::ptrdiff_t k = 1; k <= m; ++k) {
            const double w = curve[static_cast<std::size_t>(k - 1)];
            const std::ptrdiff_t after = i + k < n ? i + k : i + k - n, before = i >= k ? i - k : i - k + n;
            sum += w * (line[static_cast<std::size_t>(after)] + line[static_cast<std::size_t>(before)]);
            weights += 2 * w;
        }
        out.push_back(sum / weights);
    }
    return out;
}

/// The ring as points a chord apart that bend evenly between its corners, which turn by more than
/// 45 degrees: a brush shows a wave at each chord of a bend else. Twice the mean less the mean of
/// that keeps a circle's radius.
Line smooth(const Ring& ring, double chord) {
    constexpr double kCorner = 0.7;        // cosine
    constexpr std::ptrdiff_t kReach = 12;  // chords
    const std::size_t n = ring.size();
    const auto corner = [&](std::size_t i) {
        const Vec2 in = ring[i] - ring[(i + n - 1) % n], out = ring[(i + 1) % n] - ring[i];
        return glm::dot(in, out) < kCorner * glm::length(in) * glm::length(out);
    };
    std::size_t first = 0;
    while (first < n && !corner(first)) ++first;
    const bool closed = first == n;
    Line curve, side{ring[first % n]};
    for (std::size_t i = first + 1; i <= first + n; ++i) {
        side.push_back(ring[i % n]);
        if (!(closed ? i == first + n : corner(i % n))) continue;
        Line points = even(side, chord);
        if (!closed) points.push_back(side.back());
        const Line once = means(points, kReach, closed), twice = means(once, kReach, closed);
        for (std::size_t k = 0; k < points.size() - !closed; ++k) curve.push_back(2.0 * once[k] - twice[k]);
        side = {ring[i % n]};
    }
    return curve;
}

/// What of the curves at `d` inside the outline lies beside open edges, in runs; closed ones end
/// where they began.
std::vector<Line> runs_at(const Shape& shape, const std::vector<std::vector<Edge>>& border, double d, double width) {
    const double chord = kChord * width, beside = d + chord;
    std::vector<Vec2> middles;
    for (const std::vector<Edge>& ring : border)
        for (const Edge& e : ring)
            if (e.open) middles.push_back(e.middle());
    const Near open(beside, middles);
    std::vector<Line> runs;
    const Shape inner = shape.inset(d, 0.5 * kSlack * width);
    for (const Ring& ring : inner.rings()) {
        Line curve = smooth(ring, chord);
        std::vector<bool> wanted;
        wanted.reserve(curve.size());
        for (const Vec2& p : curve)
            wanted.push_back(open.any(p, [&](const Vec2& q) { return glm::distance(p, q) < beside; }));
        if (curve.size() < 2) continue;
        const auto gap = static_cast<std::size_t>(std::find(wanted.begin(), wanted.end(), false) - wanted.begin());
        if (gap == wanted.size()) {
            curve.push_back(curve.front());
            runs.push_back(std::move(curve));
            continue;
        }
        Line run;
        for (std::size_t i = 1; i <= curve.size(); ++i) {  // from one gap round to it
            const std::size_t at = (gap + i) % curve.size();
            if (wanted[at]) {
                run.push_back(curve[at]);
            } else {
                if (run.size() > 1) runs.push_back(std::move(run));
                run.clear();
            }
        }
    }
    return runs;
}

/// The line in parts that turn by less than some 100 degrees within `reach`: a brush goes into a
/// point and out of it in two strokes.
struct Part {
    Line line;
    bool head = false, tail = false;  ///< ends that are such points
};
std::vector<Part> split_line(const Line& line, double reach) {
    constexpr double kHairpin = -0.17;  // cosine
    const std::size_t n = line.size();
    const bool closed = n > 3 && line.front() == line.back();
    const std::size_t count = closed ? n - 1 : n;
    const auto at = [&](std::size_t i) -> const Vec2& { return line[i % count]; };
    std::vector<std::size_t> points;
    std::vector<double> turns(count, 1);
    for (std::size_t i = 0; i < count; ++i) {
        // The first vertices `reach` away to both sides.
        std::size_t back = 0, ahead = 0;
        const std::size_t most_back = closed ? count - 1 : i, most_ahead = closed ? count - 1 : count - 1 - i;
        while (back < most_back && glm::distance(at(i + count - back), at(i)) < reach) ++back;
        while (ahead < most_ahead && glm::distance(at(i + ahead), at(i)) < reach) ++ahead;
        const Vec2 in = at(i) - at(i + count - back), out = at(i + ahead) - at(i);
        if (glm::length(in) >= 0.5 * reach && glm::length(out) >= 0.5 * reach)
            turns[i] = glm::dot(glm::normalize(in), glm::normalize(out));
    }
    for (std::size_t i = 0; i < count; ++i) {  // the sharpest within reach
        check_interrupt();
        if (turns[i] > kHairpin) continue;
        bool sharpest = true;
        for (std::size_t k = 0; k < count && sharpest; ++k)
            if (k != i && glm::distance(at(k), at(i)) < reach &&
                (turns[k] < turns[i] || (turns[k] == turns[i] && k < i)))
                sharpest = false;
        if (sharpest) points.push_back(i);
    }
    if (points.empty()) return {{line}};
    std::vector<Part> parts;
    const auto part = [&](std::size_t from, std::size_t to, bool head, bool tail) {
        Part one{{}, head, tail};
        for (std::size_t i = from; i <= to; ++i) one.line.push_back(at(i));
        if (one.line.size() > 1) parts.push_back(std::move(one));
    };
    if (!closed && points.front() > 0) part(0, points.front(), false, true);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) part(points[k], points[k + 1], true, true);
    if (closed)
        part(points.back(), points.front() + count, true, true);
    else
        part(points.back(), count - 1, true, false);
    return parts;
}

/// From the end of a line at `d` from the outline, where it came to a point, into the corner of the
/// area: to where the outline along it and the one on the point's other side meet, which is
/// straight ahead on their bisector; a line `inside` others, or one that ends between others, 7/4
/// of a width; past the corner on stencil edge. The length of a path into a corner, else 0.
double run_out(Line& line, const Line& other, double d, double width, bool inside, const Shape& shape) {
    const double reach = kPoint * width;
    const auto heading = [&](const Line& l, bool from_end) {  // away from the point
        const Vec2 tip = from_end ? l.back() : l.front();
        for (std::size_t i = 1; i < l.size(); ++i)
            if (const Vec2 p = from_end ? l[l.size() - 1 - i] : l[i]; glm::distance(p, tip) >= reach)
                return glm::normalize(p - tip);
        const Vec2 p = from_end ? l.front() : l.back();
        return p == tip ? Vec2(1, 0) : glm::normalize(p - tip);
    };
    const Vec2 tip = line.back(), a = heading(line, true), b = heading(other, false);
    const Vec2 middle = -(a + b);
    if (glm::length(middle) < 0.1) return 0;
    const Vec2 ahead = glm::normalize(middle);
    const double half = 0.5 * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    constexpr double kFarthest = 8;
    double length = d / std::max(std::sin(half), 1 / kFarthest);
    constexpr int kSteps = 40;
    const double most = 1.4 * length;  // points may be bent
    int n = 0;
    while (n < kSteps && shape.contains(tip + ahead * (most * (n + 1) / kSteps))) ++n;
    const bool corner = n < kSteps;  // else the line ends where the area is narrow, between others
    double in = most * n / kSteps, out = in + most / kSteps;
    for (int k = 0; corner && k < 10; ++k)
        (shape.contains(tip + ahead * (0.5 * (in + out))) ? in : out) = 0.5 * (in + out);
    length = corner && !inside ? in + kPast * width : std::min(in, kBetween * width);
    if (length > 0) line.push_back(tip + ahead * length);
    return corner && !inside ? length : 0;
}

double length_of(const Line& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += glm::distance(line[i - 1], line[i]);
    return sum;
}

/// A dab along the middle of a small loop.
Line dab(const Line& loop, double width) {
    Vec2 a = loop.front(), b = a;
    for (const Vec2& p : loop)
        for (const Vec2& q : loop)
            if (glm::distance(p, q) > glm::distance(a, b)) a = p, b = q;
    const Vec2 middle = 0.5 * (a + b),
               half = a == b ? Vec2(0.3 * width, 0) : glm::normalize(b - a) * (0.5 * glm::distance(a, b) + 0.3 * width);
    return {middle - half, middle, middle + half};
}

/// Closes the edges that a line comes near to; whether some stay open, and with them those beside.
bool cover(std::vector<std::vector<Edge>>& border, const std::vector<AreaLine>& lines) {
    for (std::size_t from = 0, to = 0; from < lines.size(); from = to) {
        const double reach = kBare * lines[from].width;
        std::vector<Vec2> points;
        for (; to < lines.size() && lines[to].width == lines[from].width; ++to)
            points.insert(points.end(), lines[to].line.begin(), lines[to].line.end());
        const Near near(reach, points);
        for (std::vector<Edge>& ring : border)
            for (Edge& e : ring)
                if (const Vec2 p = e.middle();
                    e.open && near.any(p, [&](const Vec2& q) { return glm::distance(p, q) <= reach; }))
                    e.open = false;
    }
    constexpr std::ptrdiff_t kBeside = 30;
    bool bare = false;
    for (std::vector<Edge>& ring : border) {
        const auto n = static_cast<std::ptrdiff_t>(ring.size());
        std::vector<bool> open(ring.size(), false);
        for (std::ptrdiff_t i = 0; i < n; ++i) {
            if (!ring[static_cast<std::size_t>(i)].open) continue;
            bare = true;
            for (std::ptrdiff_t j = i - kBeside; j <= i + kBeside; ++j)
                open[static_cast<std::size_t>(((j % n) + n) % n)] = true;
        }
        for (std::size_t i = 0; i < ring.size(); ++i) ring[i].open = open[i];
    }
    return bare;
}

/// Of a line that is a third of a stem wide; 0: the shape has no area.
double line_width(const Shape& shape) {
    const double area = shape.area(), perimeter = shape.perimeter();
    if (!(area > 1e-6 * perimeter * perimeter)) return 0;
    return std::max(kStem * 2 * area / perimeter, kCompact * std::sqrt(area));
}

}  // namespace

std::vector<AreaLine> area_lines(std::span<const Ring> rings, FillRule rule) {
    const Shape shape(rings, rule);
    double w = line_width(shape);
    // A jagged outline is longer than the path along it.
    if (w > 0) w = line_width(shape.simplified(kSlack * w));
    if (!(w > 0)) return {};
    std::vector<AreaLine> lines;
    for (int level = 0; level < kLevels; ++level, w *= 0.5) {
        const Shape outline = shape.simplified(kSlack * w);
        if (outline.perimeter() / (kChord * w) > double(kMostEdges)) break;
        std::vector<std::vector<Edge>> border = border_of(outline, kChord * w);
        if (!cover(border, lines)) break;
        std::vector<std::vector<AreaLine>> shells;
        for (int k = 0; level == 0 || k < 3; ++k) {
            check_interrupt();
            const double d = (kFirst + kNext * k) * w;
            const std::vector<Line> runs = runs_at(outline, border, d, w);
            if (runs.empty()) break;
            std::vector<AreaLine> shell;
            const auto add_parts = [&](std::vector<Part> parts, int inside) {
                const std::vector<Part> all = parts;
                for (std::size_t i = 0; i < parts.size(); ++i) {
                    AreaLine line{.line = std::move(parts[i].line), .width = w};
                    if (length_of(line.line) < (level ? kFine : kShort) * w) continue;
                    if (parts[i].tail)
                        line.taper_out = run_out(line.line, all[(i + 1) % all.size()].line, d, w, inside > 0, shape);
                    if (parts[i].head) {
                        Line before = all[(i + all.size() - 1) % all.size()].line;
                        std::reverse(before.begin(), before.end());
                        std::reverse(line.line.begin(), line.line.end());
                        line.taper_in = run_out(line.line, before, d, w, inside > 0, shape);
                        std::reverse(line.line.begin(), line.line.end());
                    }
                    shell.push_back(std::move(line));
                }
            };
            for (const Line& line : runs) {
                const double around = line.front() == line.back() ? length_of(line) / w : kSmall;
                if (around < kSmall) shell.push_back({.line = dab(line, w), .width = w});
                if (around >= 0.5 * kSmall) add_parts(split_line(line, kPoint * w), k);
            }
            shells.push_back(std::move(shell));
        }
        for (auto shell = shells.rbegin(); shell != shells.rend(); ++shell)
            for (AreaLine& line : *shell) lines.push_back(std::move(line));
    }
    attach_stencils(stencil_of(shape), lines);
    return lines;
}

}  // namespace tuft::io
