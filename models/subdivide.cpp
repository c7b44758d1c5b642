#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "cage.h"
#include "core/error.h"

namespace tuft::models {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Vertex = Mesh::Vertex_index;
using Sharpness = Mesh::Property_map<Mesh::Edge_index, double>;

Vec3 to_vec(const Point& p) {
    return {p.x(), p.y(), p.z()};
}
Point to_point(const Vec3& p) {
    return {p.x, p.y, p.z};
}

/// Catmull–Clark weights, blended by the sharpness with those of a crease curve and of a corner.
class CreaseMask : public CGAL::CatmullClark_mask_3<Mesh> {
    using Base = CGAL::CatmullClark_mask_3<Mesh>;

  public:
    CreaseMask(Mesh* mesh, Sharpness sharpness)
        : Base(mesh, get(CGAL::vertex_point, *mesh)), mesh_(mesh), sharpness_(sharpness) {}

    void edge_node(Mesh::Halfedge_index h, Point& out) {
        const double s = std::min(1.0, sharpness_[mesh_->edge(h)]);
        Base::edge_node(h, out);
        if (s == 0) return;
        const Vec3 middle = 0.5 * (at(mesh_->source(h)) + at(mesh_->target(h)));
        out = to_point((1 - s) * to_vec(out) + s * middle);
    }

    /// A weak crease that ends on a sharp line pulls the vertex towards a corner, never off the line.
    void vertex_node(Vertex v, Point& out) {
        std::vector<std::pair<double, Vec3>> sharp;
        for (const Mesh::Halfedge_index h : CGAL::halfedges_around_target(v, *mesh_)) {
            const double s = sharpness_[mesh_->edge(h)];
            if (s > 0) sharp.emplace_back(s, at(mesh_->source(h)));
        }
        Base::vertex_node(v, out);
        if (sharp.size() < 2) return;
        std::stable_sort(sharp.begin(), sharp.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        const bool meet = sharp.size() > 2;
        const double third = meet ? std::min(1.0, sharp[2].first) : 0;
        const double second = std::min(1.0, meet ? sharp[1].first : 0.5 * (sharp[0].first + sharp[1].first));
        const Vec3 curve = 0.75 * at(v) + 0.125 * (sharp[0].second + sharp[1].second);
        out = to_point((1 - second) * to_vec(out) + (second - third) * curve + third * at(v));
    }

  private:
    Vec3 at(Vertex v) const { return to_vec(mesh_->point(v)); }

    Mesh* mesh_;
    Sharpness sharpness_;
};

/// After a step each old edge (a, b) is two edges a–w–b: they get what is left of its sharpness.
void inherit_sharpness(Mesh& mesh, Sharpness sharpness, std::size_t n_old,
                       const std::vector<std::tuple<Vertex, Vertex, double>>& old_edges) {
    for (const Mesh::Edge_index e : mesh.edges()) sharpness[e] = 0;
    for (const auto& [a, b, sharp] : old_edges) {
        for (const Mesh::Halfedge_index h : CGAL::halfedges_around_target(a, mesh)) {
            const Vertex w = mesh.source(h);
            if (w.idx() < n_old) continue;
            const Mesh::Halfedge_index to_b = mesh.halfedge(w, b);
            if (to_b == Mesh::null_halfedge()) continue;
            sharpness[mesh.edge(h)] = sharpness[mesh.edge(to_b)] = std::max(0.0, sharp - 1);
        }
    }
}

}  // namespace

Cage subdivide(const Cage& cage, int levels) {
    Mesh mesh;
    for (const Vec3& p : cage.points) mesh.add_vertex(to_point(p));
    for (const auto& face : cage.faces) {
        std::vector<Vertex> corners(face.begin(), face.end());
        if (mesh.add_face(corners) == Mesh::null_face()) throw Error("cage is not a manifold");
    }
    Sharpness sharpness = mesh.add_property_map<Mesh::Edge_index, double>("e:sharpness", 0).first;
    for (const auto& [edge, sharp] : cage.sharpness) {
        const Mesh::Halfedge_index h = mesh.halfedge(Vertex(edge.first), Vertex(edge.second));
        if (h != Mesh::null_halfedge()) sharpness[mesh.edge(h)] = sharp;
    }
    for (int level = 0; level < levels; ++level) {
        std::vector<std::tuple<Vertex, Vertex, double>> old_edges;
        for (const Mesh::Edge_index e : mesh.edges())
            if (sharpness[e] > 0) old_edges.emplace_back(mesh.vertex(e, 0), mesh.vertex(e, 1), sharpness[e]);
        const std::size_t n_old = mesh.number_of_vertices();
        CGAL::Subdivision_method_3::PQQ(mesh, CreaseMask(&mesh, sharpness), CGAL::parameters::number_of_iterations(1));
        inherit_sharpness(mesh, sharpness, n_old, old_edges);
    }
    Cage fine;
    for (const Vertex v : mesh.vertices()) fine.points.push_back(to_vec(mesh.point(v)));
    for (const Mesh::Face_index f : mesh.faces()) {
        std::vector<std::uint32_t> corners;
        for (const Vertex v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) corners.push_back(v.idx());
        fine.faces.push_back(std::move(corners));
    }
    return fine;
}

}  // namespace tuft::models
