#include "io/area_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace tuft::io {

namespace {

using Line = std::vector<Vec2>;

constexpr double kStem = 0.36, kCompact = 0.06;  // width of a line: of a stem, of the root of the area
constexpr double kFirst = 0.3,  kNext = 0.33;     // widths from the outline to the first line, and from one to the next
constexpr double kChord = 0.1;                  // widths, of edges and between points
constexpr double kSlack = 0.02;                 // widths that a point may lie nearer to an edge than its own
constexpr double kJoin = 0.35;                  // widths between ends that are one
constexpr double kBare = 1;                     // widths from the outline to the next line, where it counts as bare
constexpr double kPoint = 0.4;                  // widths within which a line turns at a point
constexpr double kPast = 0.5;                   // widths that it goes on past the corner, on the tape
constexpr double kBetween = 1.75;               // and between others, where it begins thin
constexpr double kSmall = 8;                    // widths: loops shorter than this get a dab in their middle, than half of it are one
constexpr double kShort = 0.5, kFine = 4;        // widths: shorter pieces are none; of finer lines
constexpr int kLevels = 4;

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Points within a radius, found by the squares of a grid as wide.
class Near {
  public:
    explicit Near(double radius) : radius_(radius) {}
    void add(const Vec2& p) { squares_[key(square(p.x), square(p.y))].push_back(p); }
    template <class Test>
    bool any(const Vec2& p, Test test) const {
        for (std::int64_t j = -1; j <= 1; ++j)
            for (std::int64_t i = -1; i <= 1; ++i)
                if (const auto at = squares_.find(key(square(p.x) + i, square(p.y) + j)); at != squares_.end())
                    for (const Vec2& q : at->second)
                        if (test(q)) return true;
        return false;
    }

  private:
    std::int64_t square(double x) const { return static_cast<std::int64_t>(std::floor(x / radius_)); }
    static std::uint64_t key(std::int64_t i, std::int64_t j) {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Fu;
    }
    double radius_;
    std::unordered_map<std::uint64_t, std::vector<Vec2>> squares_;
};

struct Edge {
    Vec2 from, to;
    Vec2 inward{0};   ///< unit; (0, 0): the area is on both sides, or on none
    bool open = true; ///< not covered yet
    bool border() const { return inward != Vec2(0); }
    Vec2 middle() const { return 0.5 * (from + to); }
};

bool within(std::span<const Line> rings, FillRule rule, const Vec2& p) {
    int winding = 0, crossings = 0;
    for (const Line& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if ((a.y <= p.y) == (b.y <= p.y)) continue;
            if ((cross(b - a, p - a) > 0) != (b.y > a.y)) continue;
            ++crossings;
            winding += b.y > a.y ? 1 : -1;
        }
    return rule == FillRule::nonzero ? winding != 0 : crossings % 2 != 0;
}

/// Area by rows, and the length of all rings.
struct Extent {
    double area = 0, perimeter = 0;
};
Extent extent(std::span<const Line> rings, FillRule rule) {
    constexpr int kRows = 256;
    Extent e;
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const Line& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            low = std::min(low, ring[i].y), high = std::max(high, ring[i].y);
            e.perimeter += glm::distance(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
        }
    std::vector<std::pair<double, int>> meets;
    for (int row = 0; row < kRows && high > low; ++row) {
        const double y = low + (high - low) * (row + 0.5) / kRows;
        meets.clear();
        for (const Line& ring : rings)
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
                if ((a.y <= y) != (b.y <= y)) meets.emplace_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), b.y > a.y ? 1 : -1);
            }
        std::sort(meets.begin(), meets.end());
        int winding = 0;
        for (std::size_t i = 0; i + 1 < meets.size(); ++i) {
            winding += rule == FillRule::nonzero ? meets[i].second : 1;
            if (rule == FillRule::nonzero ? winding != 0 : winding % 2 != 0)
                e.area += (meets[i + 1].first - meets[i].first) * (high - low) / kRows;
        }
    }
    return e;
}

/// The rings as short edges, each with the side that the area is on.
std::vector<std::vector<Edge>> border_of(std::span<const Line> rings, FillRule rule, double chord) {
    std::vector<std::vector<Edge>> border;
    for (const Line& ring : rings) {
        std::vector<Edge> edges;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if (a == b) continue;
            const Vec2 along = glm::normalize(b - a), left(-along.y, along.x);
            const auto n = static_cast<int>(std::ceil(glm::distance(a, b) / chord));
            for (int k = 0; k < n; ++k) {
                Edge e{glm::mix(a, b, double(k) / n), glm::mix(a, b, double(k + 1) / n)};
                const Vec2 step = 0.01 * chord * left;
                const bool l = within(rings, rule, e.middle() + step), r = within(rings, rule, e.middle() - step);
                if (l != r) e.inward = l ? left : -left;
                edges.push_back(e);
            }
        }
        border.push_back(std::move(edges));
    }
    return border;
}

constexpr double kTaped = 3;  // widths from a line within which the outline is taped

/// The border in straight pieces as long as they are.
std::vector<stroke::TapeEdge> tape_of(const std::vector<std::vector<Edge>>& border) {
    std::vector<stroke::TapeEdge> tape;
    for (const std::vector<Edge>& ring : border) {
        bool goes_on = false;
        Vec2 way{0}, inward{0};
        for (const Edge& e : ring) {
            if (!e.border()) {
                goes_on = false;
                continue;
            }
            const Vec2 along = glm::normalize(e.to - e.from);
            const bool turned = cross(along, e.inward) < 0;
            if (goes_on && glm::distance(along, way) + glm::distance(e.inward, inward) < 1e-9) {
                (turned ? tape.back().from : tape.back().to) = e.to;
            } else {
                tape.push_back(turned ? stroke::TapeEdge{e.to, e.from} : stroke::TapeEdge{e.from, e.to});
            }
            goes_on = true;
            way = along;
            inward = e.inward;
        }
    }
    return tape;
}

double distance_to(const stroke::TapeEdge& e, const Vec2& p) {
    const Vec2 d = e.to - e.from;
    const double length2 = glm::dot(d, d);
    return glm::distance(p, e.from + (length2 > 0 ? std::clamp(glm::dot(p - e.from, d) / length2, 0.0, 1.0) : 0.0) * d);
}

/// Gives each line the tape beside it.
void stick(const std::vector<stroke::TapeEdge>& tape, std::vector<AreaLine>& lines) {
    for (AreaLine& line : lines) {
        Vec2 low = line.line.front(), high = low;
        for (const Vec2& p : line.line) low = glm::min(low, p), high = glm::max(high, p);
        const double reach = kTaped * line.width;
        low -= reach, high += reach;
        for (const stroke::TapeEdge& e : tape) {
            if (std::max(e.from.x, e.to.x) < low.x || std::max(e.from.y, e.to.y) < low.y || std::min(e.from.x, e.to.x) > high.x ||
                std::min(e.from.y, e.to.y) > high.y)
                continue;
            if (std::any_of(line.line.begin(), line.line.end(), [&](const Vec2& p) { return distance_to(e, p) < reach; }))
                line.tape.push_back(e);
        }
    }
}

/// What of the open edges' offsets by `d` lies that far from all edges, in runs.
std::vector<Line> runs_at(const std::vector<std::vector<Edge>>& border, double d, double width) {
    Near edges(d + kChord * width);
    for (const std::vector<Edge>& ring : border)
        for (const Edge& e : ring)
            if (e.border()) edges.add(e.middle());
    const double least = d - kSlack * width;
    const auto clear = [&](const Vec2& p) { return !edges.any(p, [&](const Vec2& q) { return glm::dot(p - q, p - q) < least * least; }); };
    std::vector<Line> runs;
    for (const std::vector<Edge>& ring : border) {
        Line run;
        const auto end = [&] {
            if (run.size() > 1) runs.push_back(std::move(run));
            run.clear();
        };
        // At bends into the area offsets overlap by the slack: those that lie behind are passed over.
        const auto go = [&](const Vec2& p, const Vec2& along) {
            if (!clear(p)) return end();
            if (run.empty() || glm::dot(p - run.back(), along) > 0.2 * kChord * width) run.push_back(p);
        };
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Edge &e = ring[i], &next = ring[i + 1 < ring.size() ? i + 1 : 0];
            if (!e.border() || !e.open) {
                end();
                continue;
            }
            const Vec2 along = glm::normalize(e.to - e.from);
            go(e.middle() + d * e.inward, along);
            // Round a corner that juts into the area.
            if (next.border() && next.open && glm::dot(next.inward - e.inward, next.to - e.from) > 0) {
                const double gap = d * glm::distance(e.inward, next.inward);
                const auto n = static_cast<int>(std::min(64.0, std::ceil(gap / (kChord * width))));
                for (int k = 1; k < n; ++k) {
                    const Vec2 normal = glm::mix(e.inward, next.inward, double(k) / n);
                    const Vec2 way = d * (next.inward - e.inward);
                    if (glm::length(normal) > 0.1) go(e.to + d * glm::normalize(normal), glm::normalize(way));
                }
            }
        }
        end();
    }
    return runs;
}

/// Runs joined to lines where an end lies near the start of another, or of its own: that closes it.
std::vector<Line> joined(std::vector<Line> runs, double reach) {
    std::vector<Line> lines;
    std::vector<bool> used(runs.size(), false);
    for (std::size_t first = 0; first < runs.size(); ++first) {
        if (used[first]) continue;
        used[first] = true;
        Line line = runs[first];
        for (bool grown = true; grown;) {
            grown = false;
            double best = reach;
            std::size_t at = runs.size();
            for (std::size_t i = 0; i < runs.size(); ++i)
                if (const double gap = glm::distance(line.back(), runs[i].front()); (!used[i] || i == first) && gap < best) best = gap, at = i;
            if (at == first && line.size() > 3) {
                line.push_back(line.front());
            } else if (at < runs.size() && at != first) {
                used[at] = grown = true;
                line.insert(line.end(), runs[at].begin(), runs[at].end());
            }
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

/// The line in parts that turn by less than some 100 degrees within `reach`: a brush goes into a point and out of
/// it in two strokes.
struct Part {
    Line line;
    bool head = false, tail = false;  ///< ends that are such points
};
std::vector<Part> parted(const Line& line, double reach) {
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
        if (glm::length(in) >= 0.5 * reach && glm::length(out) >= 0.5 * reach) turns[i] = glm::dot(glm::normalize(in), glm::normalize(out));
    }
    for (std::size_t i = 0; i < count; ++i) {  // the sharpest within reach
        if (turns[i] > kHairpin) continue;
        bool sharpest = true;
        for (std::size_t k = 0; k < count && sharpest; ++k)
            if (k != i && glm::distance(at(k), at(i)) < reach && (turns[k] < turns[i] || (turns[k] == turns[i] && k < i))) sharpest = false;
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
    if (closed) part(points.back(), points.front() + count, true, true);
    else part(points.back(), count - 1, true, false);
    return parts;
}

/// From the end of a line at `d` from the outline, where it came to a point, into the corner of the area: to where the
/// outline along it and the one on the point's other side meet, which is straight ahead on their bisector; a line
/// `inside` others, or one that ends between others, 7/4 of a width; past the corner on tape. The length of a way into a corner, else 0.
double run_out(Line& line, const Line& other, double d, double width, bool inside,
               std::span<const Line> rings, FillRule rule) {
    const double reach = kPoint * width;
    const auto heading = [&](const Line& l, bool from_end) {  // away from the point
        const Vec2 tip = from_end ? l.back() : l.front();
        for (std::size_t i = 1; i < l.size(); ++i)
            if (const Vec2 p = from_end ? l[l.size() - 1 - i] : l[i]; glm::distance(p, tip) >= reach) return glm::normalize(p - tip);
        const Vec2 p = from_end ? l.front() : l.back();
        return p == tip ? Vec2(1, 0) : glm::normalize(p - tip);
    };
    const Vec2 tip = line.back(), a = heading(line, true), b = heading(other, false);
    const Vec2 middle = -(a + b);
    if (glm::length(middle) < 0.1) return 0;
    const Vec2 way = glm::normalize(middle);
    const double half = 0.5 * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    constexpr double kFarthest = 8;
    double length = d / std::max(std::sin(half), 1 / kFarthest);
    constexpr int kSteps = 40;
    const double most = 1.4 * length;  // points may be bent
    int n = 0;
    while (n < kSteps && within(rings, rule, tip + way * (most * (n + 1) / kSteps))) ++n;
    const bool corner = n < kSteps;  // else the line ends where the area is narrow, between others
    double in = most * n / kSteps, out = in + most / kSteps;
    for (int k = 0; corner && k < 10; ++k) (within(rings, rule, tip + way * (0.5 * (in + out))) ? in : out) = 0.5 * (in + out);
    length = corner && !inside ? in + kPast * width : std::min(in, kBetween * width);
    if (length > 0) line.push_back(tip + way * length);
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
    const Vec2 middle = 0.5 * (a + b), half = a == b ? Vec2(0.3 * width, 0) : glm::normalize(b - a) * (0.5 * glm::distance(a, b) + 0.3 * width);
    return {middle - half, middle, middle + half};
}

/// Closes the edges that a line comes near to; whether some stay open, and with them those beside.
bool cover(std::vector<std::vector<Edge>>& border, const std::vector<AreaLine>& lines) {
    for (std::size_t from = 0, to = 0; from < lines.size(); from = to) {
        const double reach = kBare * lines[from].width;
        Near near(reach);
        for (; to < lines.size() && lines[to].width == lines[from].width; ++to)
            for (const Vec2& p : lines[to].line) near.add(p);
        for (std::vector<Edge>& ring : border)
            for (Edge& e : ring)
                if (const Vec2 p = e.middle(); e.open && near.any(p, [&](const Vec2& q) { return glm::distance(p, q) <= reach; })) e.open = false;
    }
    constexpr std::ptrdiff_t kBeside = 30;
    bool bare = false;
    for (std::vector<Edge>& ring : border) {
        const auto n = static_cast<std::ptrdiff_t>(ring.size());
        std::vector<bool> open(ring.size(), false);
        for (std::ptrdiff_t i = 0; i < n; ++i) {
            if (!ring[static_cast<std::size_t>(i)].open || !ring[static_cast<std::size_t>(i)].border()) continue;
            bare = true;
            for (std::ptrdiff_t j = i - kBeside; j <= i + kBeside; ++j) open[static_cast<std::size_t>(((j % n) + n) % n)] = true;
        }
        for (std::size_t i = 0; i < ring.size(); ++i) ring[i].open = open[i];
    }
    return bare;
}

}  // namespace

std::vector<AreaLine> area_lines(std::span<const Line> rings, FillRule rule) {
    const Extent e = extent(rings, rule);
    if (!(e.area > 1e-4 * e.perimeter * e.perimeter / 100) || !std::isfinite(e.perimeter)) return {};
    const double width = std::max(kStem * 2 * e.area / e.perimeter, kCompact * std::sqrt(e.area));
    std::size_t n_points = 0;
    for (const Line& ring : rings) n_points += ring.size();
    std::vector<AreaLine> lines;
    std::vector<stroke::TapeEdge> tape;
    double w = width;
    for (int level = 0; level < kLevels; ++level, w *= 0.5) {
        if (e.perimeter / (kChord * w) + double(n_points) > double(kMostEdges)) break;
        std::vector<std::vector<Edge>> border = border_of(rings, rule, kChord * w);
        if (level == 0) tape = tape_of(border);
        if (!cover(border, lines)) break;
        std::vector<std::vector<AreaLine>> shells;
        for (int k = 0; level == 0 || k < 3; ++k) {
            const double d = (kFirst + kNext * k) * w;
            const std::vector<Line> runs = runs_at(border, d, w);
            if (runs.empty()) break;
            std::vector<AreaLine> shell;
            const auto add_parts = [&](std::vector<Part> parts, int inside) {
                const std::vector<Part> all = parts;
                for (std::size_t i = 0; i < parts.size(); ++i) {
                    AreaLine line{.line = std::move(parts[i].line), .width = w};
                    if (length_of(line.line) < (level ? kFine : kShort) * w) continue;
                    if (parts[i].tail) line.tail = run_out(line.line, all[(i + 1) % all.size()].line, d, w, inside > 0, rings, rule);
                    if (parts[i].head) {
                        Line before = all[(i + all.size() - 1) % all.size()].line;
                        std::reverse(before.begin(), before.end());
                        std::reverse(line.line.begin(), line.line.end());
                        line.head = run_out(line.line, before, d, w, inside > 0, rings, rule);
                        std::reverse(line.line.begin(), line.line.end());
                    }
                    shell.push_back(std::move(line));
                }
            };
            for (const Line& line : joined(runs, kJoin * w)) {
                const double around = line.front() == line.back() ? length_of(line) / w : kSmall;
                if (around < kSmall) shell.push_back({.line = dab(line, w), .width = w});
                if (around >= 0.5 * kSmall) add_parts(parted(line, kPoint * w), k);
            }
            shells.push_back(std::move(shell));
        }
        for (auto shell = shells.rbegin(); shell != shells.rend(); ++shell)
            for (AreaLine& line : *shell) lines.push_back(std::move(line));
    }
    stick(tape, lines);
    return lines;
}

}  // namespace tuft::io
