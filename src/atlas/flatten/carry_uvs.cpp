#include "atlas/flatten/carry_uvs.h"

#include <algorithm>

namespace tuft::atlas {
namespace {

/// Third corner of a triangle whose first edge lies at a, b.
Vec2 unfold(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec2& a, const Vec2& b) {
    const Vec3 e = p1 - p0, d = p2 - p0;
    const double l = std::max(glm::dot(e, e), 1e-300);
    const double along = glm::dot(d, e) / l, side = glm::length(glm::cross(e, d)) / l;
    const Vec2 u = b - a;
    return a + along * u + side * Vec2(-u.y, u.x);
}

}  // namespace

std::vector<Vec2> carry_uvs(const FlatChart& old, const ChartMesh& chart) {
    std::vector<Vec2> uv(chart.n_vertices());
    std::vector<std::uint8_t> known(chart.n_vertices(), 0), done(chart.faces.size(), 0);
    std::vector<std::uint32_t> queue;
    std::size_t o = 0;
    for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
        const std::uint32_t t = chart.triangles[f];
        while (o < old.mesh.triangles.size() && old.mesh.triangles[o] < t) ++o;
        if (o == old.mesh.triangles.size() || old.mesh.triangles[o] != t) continue;
        for (int k = 0; k < 3; ++k) {
            uv[chart.faces[f][k]] = old.uv[old.mesh.faces[o][k]];
            known[chart.faces[f][k]] = 1;
        }
        done[f] = 1;
        queue.push_back(f);
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
            const std::uint32_t g = chart.twin[h];
            if (g == kNone || done[g / 3]) continue;
            done[g / 3] = 1;
            queue.push_back(g / 3);
            const auto& f = chart.faces[g / 3];
            const std::uint32_t a = f[g % 3], b = f[(g + 1) % 3], c = f[(g + 2) % 3];
            if (known[c]) continue;
            known[c] = 1;
            uv[c] = unfold(chart.position[a], chart.position[b], chart.position[c], uv[a], uv[b]);
        }
    return uv;
}

}  // namespace tuft::atlas
