#include "writer/gesture/stroke_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/cubic.h"
#include "core/geometry/plane_vectors.h"
#include "core/geometry/segment.h"
#include "core/text/units.h"

namespace tuft::writer {
namespace {

constexpr double kApartCorners = 8, kNoCorner = 20;  // units
constexpr double kCorner = 0.75;                     // radians
constexpr double kPolylineCorner = 40 * kDegree;     // turn at a point of a polyline

struct CodeRange {
    char code;
    double lo, hi;  ///< degrees
};
constexpr std::array<CodeRange, 7> kCodes{{{'H', -24, 20},
                                           {'T', 20, 80},
                                           {'U', 80, 150},
                                           {'L', 150, 192},
                                           {'P', -168, -102},
                                           {'S', -102, -72},
                                           {'N', -72, -24}}};

std::vector<Vec2> resampled(std::span<const Vec2> line, double apart) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < line.size(); ++i) along.push_back(along.back() + glm::distance(line[i], line[i - 1]));
    const double n = std::max(4.0, std::round(along.back() / apart));
    std::vector<Vec2> out;
    for (std::size_t k = 0, i = 1; k <= static_cast<std::size_t>(n); ++k) {
        const double at = along.back() * static_cast<double>(k) / n;
        while (i + 1 < line.size() && along[i] < at) ++i;
        const double piece = along[i] - along[i - 1];
        out.push_back(
            glm::mix(line[i - 1], line[i], piece > 0 ? std::clamp((at - along[i - 1]) / piece, 0.0, 1.0) : 1));
    }
    return out;
}

std::vector<std::size_t> corners_of(const StrokeLine& line, double corner_reach) {
    const std::vector<Vec2>& p = line.points;
    const double step = line.length() / static_cast<double>(p.size() - 1);
    if (!(step > 0)) return {};
    const auto points = [&](double units) { return static_cast<std::size_t>(std::max(1.0, std::round(units / step))); };
    const std::size_t reach = points(corner_reach), apart = points(corner_reach + kApartCorners), n = p.size();
    std::vector<double> turn(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const std::size_t a = i - std::min(i, reach), b = std::min(n - 1, i + reach);
        turn[i] = std::abs(angle_between(p[i] - p[a], p[b] - p[i]));
    }
    std::vector<std::size_t> corners;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (turn[i] <= kCorner || line.along[i] <= kNoCorner || line.length() - line.along[i] <= kNoCorner) continue;
        const std::size_t a = i - std::min(i, apart), b = std::min(n - 1, i + apart);
        const auto most = std::max_element(turn.begin() + static_cast<std::ptrdiff_t>(a),
                                           turn.begin() + static_cast<std::ptrdiff_t>(b) + 1);
        if (static_cast<std::size_t>(most - turn.begin()) == i) corners.push_back(i);
    }
    return corners;
}

LineSegment segment_of(const StrokeLine& line, std::size_t first, std::size_t last) {
    LineSegment s{.first = first, .last = last, .length = line.along[last] - line.along[first]};
    const Vec2 chord = line.points[last] - line.points[first];
    s.direction = std::atan2(chord.y, chord.x);
    s.code = segment_code(s.direction);
    const double length = std::max(glm::length(chord), 1e-9);
    for (std::size_t i = first; i <= last; ++i) {
        const Vec2 d = line.points[i] - line.points[first];
        const double left = (chord.x * d.y - chord.y * d.x) / length;
        if (std::abs(left) > std::abs(s.bow)) s.bow = left;
    }
    s.bow /= std::max(s.length, 1e-9);
    return s;
}

}  // namespace

NearestPoint nearest_on_line(std::span<const Vec2> line, const Vec2& p) {
    NearestPoint nearest;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec2 q = line[i - 1] + nearest_part(line[i - 1], line[i], p) * (line[i] - line[i - 1]);
        if (const double d = glm::distance(p, q); d < nearest.distance) nearest = {q, d};
    }
    return nearest;
}

std::vector<Vec2> curve_through(std::span<const Vec2> line) {
    std::vector<Vec2> p;
    for (const Vec2& q : line)
        if (p.empty() || glm::distance(p.back(), q) > 1e-6) p.push_back(q);
    if (p.size() < 3) return p;
    const std::size_t n = p.size();
    std::vector<Vec2> tangent(n, Vec2(0));  // unit; 0: a corner or an end
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const Vec2 a = p[i] - p[i - 1], b = p[i + 1] - p[i];
        if (std::abs(angle_between(a, b)) > kPolylineCorner) continue;
        const double la = glm::length(a), lb = glm::length(b);
        tangent[i] = glm::normalize(lb / la * a + la / lb * b);
    }
    std::vector<Vec2> out{p.front()};
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const Vec2 chord = p[i + 1] - p[i];
        const double length = glm::length(chord);
        const Vec2 u = chord / length;
        Vec2 from = tangent[i], to = tangent[i + 1];
        // The other end of an arc through a free end: the mirror of its tangent about the chord.
        if (from == Vec2(0)) from = to == Vec2(0) ? u : 2 * glm::dot(u, to) * u - to;
        if (to == Vec2(0)) to = 2 * glm::dot(u, from) * u - from;
        const int pieces = std::max(1, static_cast<int>(std::ceil(length / StrokeLine::kApart)));
        for (int k = 1; k <= pieces; ++k) {
            out.push_back(hermite(p[i], p[i + 1], from, to, length, static_cast<double>(k) / pieces));
        }
    }
    return out;
}

char segment_code(double direction) {
    double degrees = std::remainder(direction / kDegree, 360.0);
    if (degrees < -168) degrees += 360;
    for (const CodeRange& r : kCodes)
        if (degrees >= r.lo && degrees < r.hi) return r.code;
    return 'L';
}

double code_direction(char code) {
    for (const CodeRange& r : kCodes)
        if (r.code == code) return 0.5 * (r.lo + r.hi) * kDegree;
    return 0;
}

std::string StrokeLine::stroke_class() const {
    std::string out;
    for (const LineSegment& s : segments) out.push_back(s.code);
    return out;
}

Vec2 StrokeLine::at(double length) const {
    const auto above = std::upper_bound(along.begin() + 1, along.end() - 1, length);
    const auto i = static_cast<std::size_t>(above - along.begin());
    const double piece = along[i] - along[i - 1];
    return glm::mix(points[i - 1], points[i], piece > 0 ? std::clamp((length - along[i - 1]) / piece, 0.0, 1.0) : 1);
}

Vec2 StrokeLine::direction(double length, double reach) const {
    const Vec2 d = at(std::min(length + reach, along.back())) - at(std::max(length - reach, 0.0));
    const double size = glm::length(d);
    return size > 1e-9 ? d / size : Vec2(1, 0);
}

StrokeLine make_stroke_line(std::span<const Vec2> median, double reach) {
    StrokeLine line;
    line.points = resampled(median, StrokeLine::kApart);
    for (int pass = 0; pass < 3; ++pass) {
        const std::vector<Vec2> p = line.points;
        for (std::size_t i = 1; i + 1 < p.size(); ++i) line.points[i] = 0.25 * p[i - 1] + 0.5 * p[i] + 0.25 * p[i + 1];
    }
    line.along.assign(1, 0.0);
    for (std::size_t i = 1; i < line.points.size(); ++i)
        line.along.push_back(line.along.back() + glm::distance(line.points[i], line.points[i - 1]));
    std::size_t first = 0;
    for (const std::size_t corner : corners_of(line, reach)) {
        line.segments.push_back(segment_of(line, first, corner));
        first = corner;
    }
    line.segments.push_back(segment_of(line, first, line.points.size() - 1));
    return line;
}

}  // namespace tuft::writer
