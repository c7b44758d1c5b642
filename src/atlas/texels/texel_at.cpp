#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "atlas/texels/cluster_graph.h"

namespace tuft::atlas {
namespace {

/// Barycentric weights of the point of the triangle that is near `p`: the projection to
/// its plane, clamped.
Vec3 clamped_weights(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Vec3& p) {
    const Vec3 a = mesh.position(triangle, 0);
    const Vec3 e1 = mesh.position(triangle, 1) - a, e2 = mesh.position(triangle, 2) - a;
    const Vec3 n = glm::cross(e1, e2);
    const double nn = glm::dot(n, n);
    if (!(nn > 0)) return {1, 0, 0};
    const double b1 = glm::dot(glm::cross(p - a, e2), n) / nn;
    const double b2 = glm::dot(glm::cross(e1, p - a), n) / nn;
    const Vec3 w = glm::max(Vec3{1 - b1 - b2, b1, b2}, Vec3{0});
    return w / (w.x + w.y + w.z);
}

/// Covered texel within `search` texels of the triangle's place in the atlas that is
/// nearest to `p` in space.
TexelRef texel_near(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, std::uint32_t triangle,
                    const Vec3& p, int search) {
    const Vec3 w = clamped_weights(mesh, triangle, p);
    Vec2 uv{0};
    for (int k = 0; k < 3; ++k) uv += w[k] * Vec2(atlas.corner_uvs[3 * std::size_t{triangle} + k]) * double(atlas.size);
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return {};
    const auto x = static_cast<std::int64_t>(std::floor(std::clamp(uv.x, 0.0, double(atlas.size))));
    const auto y = static_cast<std::int64_t>(std::floor(std::clamp(uv.y, 0.0, double(atlas.size))));
    TexelRef best;
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::int64_t dy = -search; dy <= search; ++dy) {
        for (std::int64_t dx = -search; dx <= search; ++dx) {
            const TexelRef ref = texel_ref(map, x + dx, y + dy);
            if (!ref.valid()) continue;
            const std::uint8_t cluster = map.tiles[ref.slot].cluster[ref.texel];
            if (map.cluster_chart[map.cluster_start[ref.slot] + cluster] != atlas.triangle_chart[triangle]) continue;
            const Vec3 d = Vec3(map.position(ref.slot, ref.texel)) - p;
            const double distance = glm::dot(d, d);
            const double reach = (search + 1) * double(map.reach[ref.slot]);
            if (distance >= best_distance || distance > reach * reach) continue;
            best = ref;
            best_distance = distance;
        }
    }
    return best;
}

}  // namespace

TexelRef texel_at(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, std::uint32_t triangle,
                  const Vec3& position) {
    if (triangle >= mesh.n_triangles()) return {};
    constexpr std::size_t kMaxVisited = 64;
    std::array<std::uint32_t, kMaxVisited> queue{triangle};
    std::size_t n = 1;
    for (std::size_t i = 0; i < n; ++i) {
        const TexelRef ref = texel_near(mesh, atlas, map, queue[i], position, 1);
        if (ref.valid()) return ref;
        for (int k = 0; k < 3 && n < kMaxVisited; ++k) {
            const std::uint32_t next = mesh.neighbours[3 * std::size_t{queue[i]} + k];
            if (next >= mesh.n_triangles()) continue;
            if (std::find(queue.begin(), queue.begin() + n, next) == queue.begin() + n) queue[n++] = next;
        }
    }
    return texel_near(mesh, atlas, map, triangle, position, 4);
}

}  // namespace tuft::atlas
