#include "atlas/flatten/hull.h"

#include <algorithm>
#include <limits>

#include "core/geometry/plane_vectors.h"

namespace tuft::atlas {

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Vec2> hull(2 * points.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        while (k >= 2 && cross(hull[k - 1] - hull[k - 2], points[i] - hull[k - 2]) <= 0) --k;
        hull[k++] = points[i];
    }
    const std::size_t lower = k + 1;
    for (std::size_t i = points.size() - 1; i-- > 0;) {
        while (k >= lower && cross(hull[k - 1] - hull[k - 2], points[i] - hull[k - 2]) <= 0) --k;
        hull[k++] = points[i];
    }
    hull.resize(k > 1 ? k - 1 : k);
    return hull;
}

Rectangle smallest_rectangle(const std::vector<Vec2>& hull) {
    Rectangle best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        Vec2 d = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(d);
        if (!(length > 0)) continue;
        d /= length;
        Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
        for (const Vec2& p : hull) {
            const Vec2 q(glm::dot(p, d), d.x * p.y - d.y * p.x);
            lo = glm::min(lo, q);
            hi = glm::max(hi, q);
        }
        const Vec2 side = hi - lo;
        if (side.x * side.y >= least) continue;
        least = side.x * side.y;
        if (side.x >= side.y)
            best = {side.x, side.y, d.x, d.y};
        else
            best = {side.y, side.x, -d.y, d.x};
    }
    return best;
}

}  // namespace tuft::atlas
