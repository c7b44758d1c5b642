#include "writer/gesture/sides.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/plane_vectors.h"
#include "core/hat.h"
#include "core/text/units.h"

namespace tuft::writer {
namespace {

constexpr double kMostSide = 130, kMostRay = 70;  // units
// A side counts at most this part of the median half width, and so many units more: at corners the inner ray runs down
// the other segment, and would pull the path off the corner.
constexpr double kWidest = 1.25, kWider = 10;
constexpr double kLeastEnd = 5;       // units of half width of an end
constexpr std::size_t kMostThin = 2;  // stations taken off an end
constexpr double kTangent = 12;       // units before and after, of the direction at a knot
constexpr double kArm = 36;           // units from a corner at which the width of its arms is taken
constexpr double kCornerReach = 32;   // units along the path that a corner is moved with
constexpr double kMostPush = 45;      // units
constexpr double kAreaStep = 12;      // units between places of an area: between knots a line may bend

bool contains(std::span<const Ring> rings, const Vec2& p) {
    int winding = 0;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if ((a.y <= p.y) == (b.y <= p.y)) continue;
            if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) winding += a.y <= p.y ? 1 : -1;
        }
    return winding != 0;
}

/// Distance along a ray to the nearest edge, at most `most`.
double ray_to_edge(std::span<const Ring> rings, const Vec2& p, const Vec2& d, double most) {
    double nearest = most;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = ring[i] - p, e = ring[i + 1 < ring.size() ? i + 1 : 0] - ring[i];
            const double cross = d.x * e.y - d.y * e.x;
            if (std::abs(cross) < 1e-12) continue;
            const double t = (a.x * e.y - a.y * e.x) / cross, s = (a.x * d.y - a.y * d.x) / cross;
            if (s >= 0 && s <= 1 && t > 1e-9) nearest = std::min(nearest, t);
        }
    return nearest;
}

double knot_at(const StrokeLine& line, const LineSegment& s, std::size_t k) {
    return line.along[s.first] + kKnotPlaces[k] * s.length;
}

Vec2 left_of(const Vec2& direction) {
    return {-direction.y, direction.x};
}

/// Sides at a length of the line, linear between knots.
Vec2 sides_at(const StrokeLine& line, const StrokeSides& sides, double at) {
    std::size_t s = 0;
    while (s + 1 < line.segments.size() && at > line.along[line.segments[s].last]) ++s;
    const LineSegment& segment = line.segments[s];
    const double part =
        segment.length > 0 ? std::clamp((at - line.along[segment.first]) / segment.length, 0.0, 1.0) : 0;
    std::size_t k = 1;
    while (k + 1 < kKnots && kKnotPlaces[k] < part) ++k;
    const double f = (part - kKnotPlaces[k - 1]) / (kKnotPlaces[k] - kKnotPlaces[k - 1]);
    return {std::lerp(sides.left[s][k - 1], sides.left[s][k], f),
            std::lerp(sides.right[s][k - 1], sides.right[s][k], f)};
}

/// Clearance at a point, bilinear between centres of cells.
double clearance_at(const Cells& cells, const std::vector<float>& clearance, const Vec2& p) {
    const Vec2 q = (p - cells.lo) / cells.cell - 0.5, low = glm::floor(q), f = q - low;
    const auto value = [&](int i, int j) -> double {
        if (i < 0 || j < 0 || i >= cells.width || j >= cells.height) return 0;
        return static_cast<double>(clearance[std::size_t(j) * cells.width + i]);
    };
    const int i = static_cast<int>(low.x), j = static_cast<int>(low.y);
    return std::lerp(std::lerp(value(i, j), value(i + 1, j), f.x), std::lerp(value(i, j + 1), value(i + 1, j + 1), f.x),
                     f.y);
}

/// Median of the half widths at the knots.
double median_half(const StrokeSides& sides) {
    std::vector<double> half;
    for (std::size_t s = 0; s < sides.left.size(); ++s)
        for (std::size_t k = 0; k < kKnots; ++k) half.push_back(0.5 * (sides.left[s][k] + sides.right[s][k]));
    const auto middle = half.begin() + static_cast<std::ptrdiff_t>(half.size() / 2);
    std::nth_element(half.begin(), middle, half.end());
    return *middle;
}

/// Takes off ends so thin that a brush would draw them as needles.
void blunt_ends(std::vector<Station>& s) {
    std::size_t head = 0, tail = s.size();
    while (head < kMostThin && head + 4 < tail && s[head].half < kLeastEnd) ++head;
    for (std::size_t n = 0; n < kMostThin && head + 4 < tail && s[tail - 1].half < kLeastEnd; ++n) --tail;
    s.erase(s.begin() + static_cast<std::ptrdiff_t>(tail), s.end());
    s.erase(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(head));
}

void smooth(std::vector<Station>& s, int passes) {
    for (int pass = 0; pass < passes; ++pass) {
        const std::vector<Station> p = s;
        for (std::size_t i = 1; i + 1 < s.size(); ++i)
            s[i].centre = 0.25 * p[i - 1].centre + 0.5 * p[i].centre + 0.25 * p[i + 1].centre;
    }
}

/// Moves the path out at corners, so far that ink as wide as that of both arms reaches the outer edge. A centre line
/// cuts the corner, and the width at its bisector would fill the angle with a ball.
void reach_corners(std::vector<Station>& path, const StrokeLine& line, const StrokeSides& sides) {
    const double step = line.length() / static_cast<double>(path.size() - 1);
    const std::vector<Station> before = path;
    for (std::size_t s = 0; s + 1 < line.segments.size(); ++s) {
        const LineSegment &in = line.segments[s], &on = line.segments[s + 1];
        const double at = line.along[in.last];
        const Vec2 u = line.direction(std::max(at - kArm, 0.0)), v = line.direction(std::min(at + kArm, line.length()));
        const bool to_left = u.x * v.y - u.y * v.x > 0;
        const Vec2 side = sides_at(line, sides, at),
                   outward = (to_left ? -1.0 : 1.0) * left_of(line.direction(at, kTangent));
        const auto half_at = [&](double where) {
            return before[static_cast<std::size_t>(std::clamp(where / step, 0.0, static_cast<double>(path.size() - 1)))]
                .half;
        };
        const double half =
            0.5 * (half_at(at - std::min(kArm, 0.5 * in.length)) + half_at(at + std::min(kArm, 0.5 * on.length)));
        const auto corner = static_cast<std::size_t>(std::lround(at / step));
        const double there = glm::dot(before[corner].centre - line.at(at), outward);
        const double push = std::clamp((to_left ? side.y : side.x) - half - there, 0.0, kMostPush);
        for (std::size_t i = 0; i < path.size(); ++i) {
            const double weight = hat(static_cast<double>(i) * step - at, kCornerReach);
            if (weight > 0) path[i].centre += weight * push * outward;
        }
    }
}

}  // namespace

StrokeSides measure_sides(const StrokeLine& line, std::span<const Ring> outline) {
    StrokeSides sides;
    const auto reach = [&](const Vec2& p, const Vec2& d, double most) {
        return contains(outline, p) ? ray_to_edge(outline, p, d, most) : 0;
    };
    for (const LineSegment& s : line.segments) {
        sides.left.emplace_back(), sides.right.emplace_back();
        for (std::size_t k = 0; k < kKnots; ++k) {
            const double at = knot_at(line, s, k);
            const Vec2 p = line.at(at), left = left_of(line.direction(at, kTangent));
            sides.left.back()[k] = reach(p, left, kMostSide);
            sides.right.back()[k] = reach(p, -left, kMostSide);
        }
    }
    const Vec2 back = -line.direction(0, kTangent), on = line.direction(line.length(), kTangent);
    for (std::size_t k = 0; k < kFan; ++k) {
        sides.head[k] = reach(line.points.front(), turned(back, kFanDegrees[k] * kDegree), kMostRay);
        sides.tail[k] = reach(line.points.back(), turned(on, kFanDegrees[k] * kDegree), kMostRay);
    }
    return sides;
}

std::vector<Ring> area_of(const StrokeLine& line, const StrokeSides& sides) {
    std::vector<Ring> rings;
    Vec2 left_before{0}, right_before{0};
    Ring head, tail;
    const auto add = [&](double at, double left_side, double right_side) {
        const Vec2 p = line.at(at), normal = left_of(line.direction(at, kTangent));
        const Vec2 left = p + left_side * normal, right = p - right_side * normal;
        if (head.empty())
            head = {p, right};
        else
            rings.push_back({left_before, right_before, right, left});
        tail = {p, left};
        left_before = left, right_before = right;
    };
    for (std::size_t s = 0; s < line.segments.size(); ++s)
        for (std::size_t k = 0; k < kKnots; ++k) {
            const double at = knot_at(line, line.segments[s], k);
            if (k > 0) {
                const double before = knot_at(line, line.segments[s], k - 1);
                const int n = static_cast<int>(std::ceil((at - before) / kAreaStep));
                for (int i = 1; i < n; ++i) {
                    const double f = static_cast<double>(i) / n;
                    add(std::lerp(before, at, f), std::lerp(sides.left[s][k - 1], sides.left[s][k], f),
                        std::lerp(sides.right[s][k - 1], sides.right[s][k], f));
                }
            }
            add(at, sides.left[s][k], sides.right[s][k]);
            if (s == 0 && k == 0) {
                const Vec2 back = -line.direction(0, kTangent);
                // Anticlockwise of the direction back lies the right of the line.
                for (std::size_t f = 0; f < kFan; ++f)
                    head.push_back(line.points.front() + sides.head[f] * turned(back, kFanDegrees[f] * kDegree));
                head.push_back(left_before);
            }
        }
    const Vec2 end = line.points.back(), on = line.direction(line.length(), kTangent);
    for (std::size_t f = 0; f < kFan; ++f) tail.push_back(end + sides.tail[f] * turned(on, kFanDegrees[f] * kDegree));
    tail.push_back(right_before);
    rings.push_back(head), rings.push_back(tail);
    return rings;
}

std::vector<Station> resample_stations(std::span<const Station> stations, double apart) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < stations.size(); ++i)
        along.push_back(along.back() + glm::distance(stations[i].centre, stations[i - 1].centre));
    const double n = std::max(3.0, std::round(along.back() / apart));
    std::vector<Station> out;
    for (std::size_t k = 0, i = 1; k <= static_cast<std::size_t>(n); ++k) {
        const double at = along.back() * static_cast<double>(k) / n;
        while (i + 1 < stations.size() && along[i] < at) ++i;
        const double piece = along[i] - along[i - 1];
        const double f = piece > 0 ? std::clamp((at - along[i - 1]) / piece, 0.0, 1.0) : 1;
        out.push_back({glm::mix(stations[i - 1].centre, stations[i].centre, f),
                       std::lerp(stations[i - 1].half, stations[i].half, f)});
    }
    return out;
}

std::vector<Station> make_stations(const StrokeLine& line, const StrokeSides& sides, const Cells& area, bool corners) {
    std::vector<Station> path;
    const double cap = kWidest * median_half(sides) + kWider;
    const auto n = static_cast<int>(std::max(2.0, std::round(line.length() / kStationsApart)));
    for (int i = 0; i <= n; ++i) {
        const double at = line.length() * i / n;
        const Vec2 side = glm::min(sides_at(line, sides, at), Vec2(cap));
        const Vec2 normal = left_of(line.direction(at, kTangent));
        path.push_back({line.at(at) + 0.5 * (side.x - side.y) * normal, 0.5 * (side.x + side.y)});
    }
    smooth(path, 4);
    if (corners) reach_corners(path, line, sides);
    const auto continue_by = [](const Station& end, const Station& inner, double length) {
        const Vec2 d = end.centre - inner.centre;
        const double size = glm::length(d);
        return Station{size > 1e-9 ? end.centre + length / size * d : end.centre, 0};
    };
    const std::size_t in = std::min<std::size_t>(2, path.size() - 1);
    const Station head = continue_by(path.front(), path[in], sides.head[kFan / 2]);
    const Station tail = continue_by(path.back(), path[path.size() - 1 - in], sides.tail[kFan / 2]);
    path.front().half = std::max(path.front().half, 1.0), path.back().half = std::max(path.back().half, 1.0);
    path.insert(path.begin(), head);
    path.push_back(tail);
    std::vector<Station> stations = resample_stations(path, kStationsApart);
    const std::vector<float> clearance = clearances(area);
    const double head_end = glm::distance(path[0].centre, path[1].centre);
    double along = 0, whole = 0;
    for (std::size_t i = 1; i < stations.size(); ++i)
        whole += glm::distance(stations[i].centre, stations[i - 1].centre);
    const double tail_begin = whole - glm::distance(path.back().centre, path[path.size() - 2].centre);
    for (std::size_t i = 0; i < stations.size(); ++i) {
        if (i > 0) along += glm::distance(stations[i].centre, stations[i - 1].centre);
        const double room = clearance_at(area, clearance, stations[i].centre);
        const bool beyond = along < head_end || along > tail_begin;
        stations[i].half = beyond ? room : std::min(stations[i].half, room);
    }
    blunt_ends(stations);
    return stations;
}

}  // namespace tuft::writer
