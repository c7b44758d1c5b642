#include "atlas/flatten/reference.h"

#include <algorithm>

namespace tuft::atlas {

Reference reference_triangle(const ChartMesh& chart, std::size_t t, double min_height) {
    const auto& f = chart.faces[t];
    int k = 0;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
        const double l = glm::length(chart.position[f[(i + 1) % 3]] - chart.position[f[i]]);
        if (l > longest) {
            longest = l;
            k = i;
        }
    }
    longest = std::max(longest, 1e-150);
    const Vec3 along = (chart.position[f[(k + 1) % 3]] - chart.position[f[k]]) / longest;
    const Vec3 side = chart.position[f[(k + 2) % 3]] - chart.position[f[k]];
    const double height = std::max(glm::length(glm::cross(along, side)), min_height * longest);
    Reference r;
    r.corner[k] = {0, 0};
    r.corner[(k + 1) % 3] = {longest, 0};
    r.corner[(k + 2) % 3] = {glm::dot(along, side), height};
    r.area = 0.5 * longest * height;
    for (int i = 0; i < 3; ++i) {
        const Vec2 a = r.corner[i] - r.corner[(i + 2) % 3];
        const Vec2 b = r.corner[(i + 1) % 3] - r.corner[(i + 2) % 3];
        r.half_cot[i] = 0.5 * glm::dot(a, b) / (2 * r.area);
    }
    return r;
}

}  // namespace tuft::atlas
