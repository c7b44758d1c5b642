#include "writer/gesture/corners.h"

#include <algorithm>
#include <cmath>

namespace tuft::writer {
namespace {

constexpr double kAxisNear = 40, kAxisFar = 100;           // units from a corner, of an arm's axis
constexpr double kAxisNearPart = 0.4, kAxisFarPart = 0.9;  // of its length, at most
constexpr double kOuterReach = 60, kInnerReach = 110;      // units along the line in which sides are limited
constexpr double kOuterSlack = 6;                          // units beyond either arm
constexpr double kMiter = 1.6;                             // of the wider arm, the outer side of a sharp corner
constexpr double kHead = 70;                               // units: a shorter first segment is a head
constexpr double kInnerMore = 6, kInnerLess = 8;           // units from the inner edge of the own arm
constexpr double kThickened = 1.2;                         // of the median outer side of an arm, before a corner
constexpr double kWidestInner = 1.5;                       // inner half width, of the outer one, at most
constexpr double kLeastCosine = 0.2;                       // between a side and the edge that limits it
constexpr double kKnotTangent = 12;                        // units before and after, of the direction at a knot

using Knots = std::array<double, kKnots>;

double at_part(const Knots& knots, double part) {
    std::size_t k = 1;
    while (k + 1 < kKnots && kKnotPlaces[k] < part) ++k;
    const double f = (part - kKnotPlaces[k - 1]) / (kKnotPlaces[k] - kKnotPlaces[k - 1]);
    return std::lerp(knots[k - 1], knots[k], f);
}

double median_of(Knots knots) {
    std::nth_element(knots.begin(), knots.begin() + kKnots / 2, knots.end());
    return knots[kKnots / 2];
}

/// One of the two arms of a corner.
struct Arm {
    Vec2 at{0}, outward{0};       // a point of its axis, and the unit normal to the outside of the corner
    double outer = 0, inner = 0;  // units, half widths
};

Arm arm_of(const StrokeLine& line, const StrokeSides& sides, std::size_t segment, bool before, bool to_left) {
    const LineSegment& s = line.segments[segment];
    const double near = std::min(kAxisNear, kAxisNearPart * s.length),
                 far = std::min(kAxisFar, kAxisFarPart * s.length);
    const double corner = line.along[before ? s.last : s.first], sign = before ? -1 : 1;
    Arm arm{.at = line.at(corner + sign * near)};
    const Vec2 d = sign * (line.at(corner + sign * far) - arm.at);
    const double size = std::max(glm::length(d), 1e-9);
    arm.outward = (to_left ? 1.0 : -1.0) * Vec2(d.y, -d.x) / size;
    const double part = near / std::max(s.length, 1e-9);
    const Knots &outer = (to_left ? sides.right : sides.left)[segment],
                &inner = (to_left ? sides.left : sides.right)[segment];
    arm.outer = std::min(at_part(outer, before ? 1 - part : part), kThickened * median_of(outer));
    arm.inner = std::min(median_of(inner), kWidestInner * arm.outer);
    return arm;
}

/// How far one may go from `p` along the unit vector `n` until `half` units from an axis are reached.
double distance_to_edge(const Vec2& p, const Vec2& n, const Vec2& axis, const Vec2& normal, double half) {
    const double cosine = glm::dot(n, normal);
    return cosine < kLeastCosine ? 1e9 : (half - glm::dot(p - axis, normal)) / cosine;
}

}  // namespace

void limit_corners(const StrokeLine& line, StrokeSides& sides) {
    const StrokeSides predicted = sides;
    for (std::size_t s = 0; s + 1 < line.segments.size(); ++s) {
        if (s == 0 && line.segments[0].length < kHead) continue;
        const double corner = line.along[line.segments[s].last];
        const Vec2 u = line.direction(std::max(corner - kAxisNear, 0.0)),
                   v = line.direction(std::min(corner + kAxisNear, line.length()));
        const bool to_left = u.x * v.y - u.y * v.x > 0;
        const Arm arms[] = {arm_of(line, predicted, s, true, to_left), arm_of(line, predicted, s + 1, false, to_left)};
        const double most = kMiter * (std::max(arms[0].outer, arms[1].outer) + kOuterSlack);
        for (std::size_t a = 0; a < 2; ++a)
            for (std::size_t k = 0; k < kKnots; ++k) {
                const LineSegment& segment = line.segments[s + a];
                const double at = line.along[segment.first] + kKnotPlaces[k] * segment.length;
                const Vec2 p = line.at(at), d = line.direction(at, kKnotTangent),
                           out = (to_left ? 1.0 : -1.0) * Vec2(d.y, -d.x);
                double& outer = (to_left ? sides.right : sides.left)[s + a][k];
                double& inner = (to_left ? sides.left : sides.right)[s + a][k];
                if (std::abs(at - corner) <= kOuterReach) {
                    outer = std::min(outer, most);
                    for (const Arm& arm : arms)
                        outer = std::min(outer, std::max(1.0, distance_to_edge(p, out, arm.at, arm.outward,
                                                                               arm.outer + kOuterSlack)));
                }
                if (std::abs(at - corner) > kInnerReach) continue;
                const double edge = distance_to_edge(p, -out, arms[a].at, -arms[a].outward, arms[a].inner);
                if (edge > 1e8) continue;
                inner = std::clamp(inner, std::max(1.0, std::min(edge, arms[a].inner) - kInnerLess),
                                   std::max(1.0, edge + kInnerMore));
            }
    }
}

}  // namespace tuft::writer
