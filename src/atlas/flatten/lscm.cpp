#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <cmath>
#include <mutex>

#include "atlas/flatten/flatten.h"

namespace tuft::atlas {
namespace {

constexpr std::size_t kLarge = 50000;  // triangles

}  // namespace

std::optional<std::vector<Vec2>> lscm(const ChartMesh& chart) {
    namespace Smp = CGAL::Surface_mesh_parameterization;
    using Kernel = CGAL::Simple_cartesian<double>;
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    // CGAL crashes on anything but a disk instead of refusing it.
    if (!chart.disk) return std::nullopt;

    // Takes some 700 bytes a triangle for a second or two: large charts one after the other.
    static std::mutex large;
    std::unique_lock<std::mutex> turn(large, std::defer_lock);
    if (chart.faces.size() > kLarge) turn.lock();

    Mesh mesh;
    mesh.reserve(chart.n_vertices(), 3 * chart.faces.size(), chart.faces.size());
    for (const Vec3& p : chart.position) mesh.add_vertex({p.x, p.y, p.z});
    using Vertex = Mesh::Vertex_index;
    for (const auto& f : chart.faces)
        if (mesh.add_face(Vertex(f[0]), Vertex(f[1]), Vertex(f[2])) == Mesh::null_face()) return std::nullopt;
    Mesh::Halfedge_index border = Mesh::null_halfedge();
    for (const Mesh::Halfedge_index h : mesh.halfedges())
        if (mesh.is_border(h)) {
            border = h;
            break;
        }
    if (border == Mesh::null_halfedge()) return std::nullopt;

    auto uv_map = mesh.add_property_map<Vertex, Kernel::Point_2>("v:uv").first;
    using Border = Smp::Two_vertices_parameterizer_3<Mesh>;
    Smp::LSCM_parameterizer_3<Mesh, Border> parameterizer;
    if (Smp::parameterize(mesh, parameterizer, border, uv_map) != Smp::OK) return std::nullopt;

    std::vector<Vec2> uv(chart.n_vertices());
    for (std::size_t v = 0; v < uv.size(); ++v) {
        const Kernel::Point_2& p = uv_map[Vertex(static_cast<std::uint32_t>(v))];
        uv[v] = {p.x(), p.y()};
        if (!std::isfinite(uv[v].x) || !std::isfinite(uv[v].y)) return std::nullopt;
    }
    scale_to_area(chart, uv);
    return uv;
}

}  // namespace tuft::atlas
