#include "contact/sphere.h"

#include <cmath>

namespace tuft::contact {
namespace {

std::size_t farthest(std::span<const Vec3> points, const Vec3& from) {
    std::size_t best = 0;
    double best2 = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 d = points[i] - from;
        const double d2 = glm::dot(d, d);
        if (d2 > best2) {
            best2 = d2;
            best = i;
        }
    }
    return best;
}

}  // namespace

Sphere expand_ball(std::span<const Vec3> points, double epsilon, int max_iterations) {
    Sphere s;
    if (points.empty()) return s;
    const Vec3 b = points[farthest(points, points[0])];
    const Vec3 c = points[farthest(points, b)];
    s.centre = 0.5 * (b + c);
    double r = 0.5 * glm::length(c - b);
    s.r_start = r;
    for (;; ++s.iterations) {
        const Vec3 e = points[farthest(points, s.centre)];
        const double l = glm::length(e - s.centre);
        s.radius = l;
        s.r_expanded = r;
        s.converged = l <= (1 + epsilon) * r;
        if (s.converged || s.iterations >= max_iterations || !(l > 0)) return s;
        const double grown = (r * r + l * l) / (2 * l);
        s.centre += (l - grown) / l * (e - s.centre);
        r = grown;
    }
}

}  // namespace tuft::contact
