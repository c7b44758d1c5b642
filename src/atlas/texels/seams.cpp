#include "atlas/texels/seams.h"

#include <algorithm>
#include <cmath>

#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

/// Corners of one chart that belong together may differ by this much, texels.
constexpr double kSameCorner = 1.0 / 64;

/// Corner of `other` at which its side of the edge (corner k → k+1 of `triangle`) starts, or −1.
int facing_corner(const mesh::TriangleMesh& mesh, std::uint32_t triangle, int k, std::uint32_t other) {
    const auto& t = mesh.triangles[triangle];
    const auto& o = mesh.triangles[other];
    for (int l = 0; l < 3; ++l) {
        if (o[l] == t[(k + 1) % 3] && o[(l + 1) % 3] == t[k]) return l;
    }
    return -1;
}

bool finite(const Vec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

}  // namespace

Vec2 corner_texels(const Atlas& atlas, std::uint32_t triangle, int corner) {
    const Vec2 uv(atlas.corner_uvs[3 * std::size_t{triangle} + corner]);
    return glm::clamp(uv, 0.0, 1.0) * double(atlas.size);
}

std::vector<SeamEdge> find_seams(const mesh::TriangleMesh& mesh, const Atlas& atlas) {
    std::vector<SeamEdge> seams;
    for (std::uint32_t a = 0; a < mesh.n_triangles(); ++a) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t b = mesh.neighbours[3 * std::size_t{a} + k];
            if (b == kNone || b <= a || b >= mesh.n_triangles()) continue;
            const int l = facing_corner(mesh, a, k, b);
            if (l < 0) continue;
            const Vec2 a0 = corner_texels(atlas, a, k), a1 = corner_texels(atlas, a, (k + 1) % 3);
            const Vec2 b0 = corner_texels(atlas, b, (l + 1) % 3), b1 = corner_texels(atlas, b, l);
            if (!finite(a0) || !finite(a1) || !finite(b0) || !finite(b1)) continue;
            if (atlas.triangle_chart[a] == atlas.triangle_chart[b] && glm::length(a0 - b0) < kSameCorner &&
                glm::length(a1 - b1) < kSameCorner)
                continue;
            seams.push_back({a, b, k, l});
        }
    }
    return seams;
}

void sample_seam(const mesh::TriangleMesh& mesh, const Atlas& atlas, const SeamEdge& edge, double spacing,
                 std::vector<SeamSample>& samples) {
    const int a_end = (edge.corner_a + 1) % 3, b_end = (edge.corner_b + 1) % 3;
    const Vec2 a0 = corner_texels(atlas, edge.triangle_a, edge.corner_a);
    const Vec2 a1 = corner_texels(atlas, edge.triangle_a, a_end);
    const Vec2 b0 = corner_texels(atlas, edge.triangle_b, b_end);
    const Vec2 b1 = corner_texels(atlas, edge.triangle_b, edge.corner_b);
    const double length_a = glm::length(a1 - a0), length_b = glm::length(b1 - b0);
    const int n = std::max(1, int(std::ceil(std::max(length_a, length_b) / spacing)));
    const auto normal = [&](std::uint32_t triangle, int from, int to, double f) {
        const Vec3 m = (1 - f) * Vec3(mesh.corner_normals[3 * std::size_t{triangle} + from]) +
                       f * Vec3(mesh.corner_normals[3 * std::size_t{triangle} + to]);
        const double length = glm::length(m);
        return length > 1e-6 ? m / length : Vec3{0, 0, 1};
    };
    for (int i = 0; i < n; ++i) {
        const double f = (i + 0.5) / n;
        SeamSample s;
        s.position =
            (1 - f) * mesh.position(edge.triangle_a, edge.corner_a) + f * mesh.position(edge.triangle_a, a_end);
        s.length = 0.5 * (length_a + length_b) / n;
        s.a = {edge.triangle_a, (1 - f) * a0 + f * a1, length_a > 0 ? (a1 - a0) / length_a : Vec2{1, 0},
               normal(edge.triangle_a, edge.corner_a, a_end, f)};
        s.b = {edge.triangle_b, (1 - f) * b0 + f * b1, length_b > 0 ? (b1 - b0) / length_b : Vec2{1, 0},
               normal(edge.triangle_b, b_end, edge.corner_b, f)};
        samples.push_back(s);
    }
}

TexelRef nearest_texel(const TexelMap& map, std::uint32_t chart, const Vec2& uv, const Vec3& position,
                       double max_distance) {
    const std::int64_t x0 = static_cast<std::int64_t>(std::ceil(uv.x - 0.5 - max_distance));
    const std::int64_t x1 = static_cast<std::int64_t>(std::floor(uv.x - 0.5 + max_distance));
    const std::int64_t y0 = static_cast<std::int64_t>(std::ceil(uv.y - 0.5 - max_distance));
    const std::int64_t y1 = static_cast<std::int64_t>(std::floor(uv.y - 0.5 + max_distance));
    TexelRef best;
    double best_distance = max_distance * max_distance;
    for (std::int64_t y = y0; y <= y1; ++y) {
        for (std::int64_t x = x0; x <= x1; ++x) {
            const Vec2 d = Vec2(double(x) + 0.5, double(y) + 0.5) - uv;
            const double distance = glm::dot(d, d);
            if (distance > best_distance || (best.valid() && distance == best_distance)) continue;
            const TexelRef ref = texel_ref(map, x, y);
            if (!ref.valid()) continue;
            const std::uint8_t cluster = map.tiles[ref.slot].cluster[ref.texel];
            if (map.cluster_chart[map.cluster_start[ref.slot] + cluster] != chart) continue;
            const double reach = map.reach[ref.slot] * std::max(1.0, max_distance);
            const Vec3 gap = Vec3(map.position(ref.slot, ref.texel)) - position;
            if (glm::dot(gap, gap) > reach * reach) continue;
            best = ref;
            best_distance = distance;
        }
    }
    return best;
}

}  // namespace tuft::atlas
