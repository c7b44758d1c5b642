#include "mesh/triangle_mesh.h"

namespace tuft::mesh {

SurfacePoint surface_point(const TriangleMesh& mesh, std::uint32_t triangle, double b1, double b2) {
    const Vec3 p0 = mesh.position(triangle, 0);
    const Vec3 d1 = mesh.position(triangle, 1) - p0;
    const Vec3 d2 = mesh.position(triangle, 2) - p0;
    const std::size_t c = 3 * std::size_t{triangle};
    const Vec3 n = (1 - b1 - b2) * Vec3(mesh.corner_normals[c]) + b1 * Vec3(mesh.corner_normals[c + 1]) +
                   b2 * Vec3(mesh.corner_normals[c + 2]);
    SurfacePoint s;
    s.triangle = triangle;
    s.b1 = b1;
    s.b2 = b2;
    s.position = p0 + b1 * d1 + b2 * d2;
    s.face_normal = glm::normalize(glm::cross(d1, d2));
    const double length = glm::length(n);
    s.normal = length > 1e-6 ? n / length : s.face_normal;
    return s;
}

Vec3 face_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const Vec3 from = mesh.position(triangle, 0);
    return glm::normalize(glm::cross(mesh.position(triangle, 1) - from, mesh.position(triangle, 2) - from));
}

double surface_area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 p0 = mesh.position(t, 0);
        sum += 0.5 * glm::length(glm::cross(mesh.position(t, 1) - p0, mesh.position(t, 2) - p0));
    }
    return sum;
}

}  // namespace tuft::mesh
