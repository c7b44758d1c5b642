#include "atlas/seams/half_edges.h"

#include <algorithm>
#include <cmath>

namespace tuft::atlas {

std::vector<std::uint32_t> twin_half_edges(const mesh::TriangleMesh& mesh) {
    const std::size_t n = mesh.n_triangles();
    std::vector<std::uint32_t> twin(3 * n, kNone);
    for (std::uint32_t h = 0; h < 3 * n; ++h) {
        const std::uint32_t other = mesh.neighbours[h];
        if (other >= n || twin[h] != kNone) continue;
        const std::uint32_t from = mesh.triangles[h / 3][h % 3];
        const std::uint32_t to = mesh.triangles[h / 3][next_half(h) % 3];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t g = 3 * other + k;
            if (g != h && twin[g] == kNone && mesh.triangles[other][k] == to &&
                mesh.triangles[other][(k + 1) % 3] == from && mesh.neighbours[g] == h / 3) {
                twin[h] = g;
                twin[g] = h;
                break;
            }
        }
    }
    return twin;
}

std::uint32_t local_half(std::span<const std::uint32_t> triangles, std::uint32_t h) {
    if (h == kNone) return kNone;
    const auto it = std::lower_bound(triangles.begin(), triangles.end(), h / 3);
    if (it == triangles.end() || *it != h / 3) return kNone;
    return 3 * static_cast<std::uint32_t>(it - triangles.begin()) + h % 3;
}

Patch make_patch(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin,
                 std::vector<std::uint32_t> triangles, double unit) {
    Patch patch;
    const auto n = static_cast<std::uint32_t>(triangles.size());
    const bool whole = n == mesh.n_triangles();
    patch.twin.resize(3 * std::size_t{n});
    for (std::uint32_t h = 0; h < 3 * n; ++h) {
        const std::uint32_t g = twin[3 * triangles[h / 3] + h % 3];
        patch.twin[h] = whole ? g : local_half(triangles, g);
    }

    // A vertex is found from its first corner by turning both ways round the fan.
    patch.vertex.assign(3 * std::size_t{n}, kNone);
    for (std::uint32_t c = 0; c < 3 * n; ++c) {
        if (patch.vertex[c] != kNone) continue;
        const std::uint32_t v = patch.n_vertices++;
        for (std::uint32_t h = c; h != kNone && patch.vertex[h] == kNone; h = patch.twin[prev_half(h)])
            patch.vertex[h] = v;
        for (std::uint32_t g = patch.twin[c]; g != kNone;) {
            const std::uint32_t h = next_half(g);
            if (patch.vertex[h] != kNone) break;
            patch.vertex[h] = v;
            g = patch.twin[h];
        }
    }

    patch.normal.resize(n);
    patch.area.resize(n);
    patch.length.resize(3 * std::size_t{n});
    for (std::uint32_t t = 0; t < n; ++t) {
        Vec3 p[3];
        for (int k = 0; k < 3; ++k) p[k] = mesh.position(triangles[t], k) / unit;
        const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double twice = glm::length(cross);
        patch.normal[t] = twice > 0 ? Vec3f(cross / twice) : Vec3f(0, 0, 1);
        patch.area[t] = static_cast<float>(0.5 * twice);
        for (int k = 0; k < 3; ++k) patch.length[3 * t + k] = static_cast<float>(glm::length(p[(k + 1) % 3] - p[k]));
    }
    patch.triangles = std::move(triangles);
    return patch;
}

std::vector<float> vertex_angles(const Patch& patch) {
    std::vector<float> angle(patch.n_vertices, 0);
    for (std::uint32_t h = 0; h < patch.vertex.size(); ++h) {
        const double a = patch.length[h], b = patch.length[prev_half(h)];
        const double c = patch.length[next_half(h)];
        if (!(a > 0) || !(b > 0)) continue;
        angle[patch.vertex[h]] +=
            static_cast<float>(std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0)));
    }
    return angle;
}

}  // namespace tuft::atlas
