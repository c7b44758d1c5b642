#include "stroke/surface/sharp_edges.h"

#include <cmath>

namespace tuft::stroke {
namespace {

bool is_sharp(const mesh::TriangleMesh& mesh, std::size_t i, std::size_t other, double angle) {
    const Vec3 n = mesh::face_normal(mesh, i), m = mesh::face_normal(mesh, other);
    return std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m)) > angle;
}

}  // namespace

std::vector<SharpEdge> sharp_edges(const mesh::TriangleMesh& mesh, double angle) {
    std::vector<SharpEdge> edges;
    for (std::size_t i = 0; i < mesh.n_triangles(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t other = mesh.neighbours[3 * i + k];
            if (other != kNone && (other < i || !is_sharp(mesh, i, other, angle))) continue;
            edges.push_back({mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]});
        }
    return edges;
}

}  // namespace tuft::stroke
