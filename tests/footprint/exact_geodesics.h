#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "core/geometry/types.h"
#include "mesh/triangle_mesh.h"

/// Exact shortest paths over the triangles near a point ([Xin2009], by CGAL): what the
/// log map of stamps is measured against on meshes.
namespace tuft::testing {

class ExactGeodesics {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    using Paths = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Surface>>;

  public:
    /// All triangles that hang together with `triangle` within `radius` metres of `origin`,
    /// which lies in it.
    ExactGeodesics(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Vec3& origin, double radius)
        : mesh_(mesh), origin_(origin) {
        std::vector<std::uint32_t> open{triangle};
        face_.try_emplace(triangle);
        for (std::size_t i = 0; i < open.size(); ++i) {
            std::array<Surface::Vertex_index, 3> v;
            for (int k = 0; k < 3; ++k) v[k] = vertex(mesh.triangles[open[i]][k]);
            face_[open[i]] = surface_.add_face(v[0], v[1], v[2]);
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t next = mesh.neighbours[3 * std::size_t{open[i]} + k];
                if (next == kNone || face_.contains(next) || !near(next, radius)) continue;
                face_.try_emplace(next);
                open.push_back(next);
            }
        }
        paths_ = std::make_unique<Paths>(surface_);
        paths_->add_source_point(face_.at(triangle), weights(face_.at(triangle), origin));
    }

    /// Length of the shortest path to the point `p` of `triangle`, metres, and the unit direction
    /// in which it leaves the origin; infinity where no path leads there.
    struct Geodesic {
        double length = std::numeric_limits<double>::infinity();
        Vec3 direction{0};
        bool bent = false;  ///< it bends round a vertex: the straight paths from the origin do not
                            ///< reach the point, as behind an opening
    };
    Geodesic to(std::uint32_t triangle, const Vec3& p) const {
        Geodesic path;
        const auto found = face_.find(triangle);
        if (found == face_.end() || found->second == Surface::null_face()) return path;
        std::vector<Kernel::Point_3> points;
        Bends bends;
        paths_->shortest_path_sequence_to_source_points(found->second, weights(found->second, p), bends);
        path.bent = bends.any;
        const auto result = paths_->shortest_path_points_to_source_points(found->second, weights(found->second, p),
                                                                          std::back_inserter(points));
        if (points.size() < 2 || result.second == paths_->source_points_end()) return path;
        path.length = result.first;
        for (std::size_t i = points.size() - 1; i-- > 0;) {
            const Vec3 d = Vec3(points[i].x(), points[i].y(), points[i].z()) - origin_;
            if (glm::length(d) < 1e-9) continue;
            path.direction = glm::normalize(d);
            break;
        }
        return path;
    }

    std::size_t n_triangles() const { return surface_.number_of_faces(); }

  private:
    struct Bends {
        bool any = false;
        void operator()(Surface::Halfedge_index, double) {}
        void operator()(Surface::Vertex_index) { any = true; }
        void operator()(Surface::Face_index, const Paths::Barycentric_coordinates&) {}
    };

    bool near(std::uint32_t triangle, double radius) const {
        // Of the box of the triangle, at most as far as the triangle itself.
        Vec3 lo(1e30), hi(-1e30);
        for (int k = 0; k < 3; ++k) {
            lo = glm::min(lo, mesh_.position(triangle, k));
            hi = glm::max(hi, mesh_.position(triangle, k));
        }
        return glm::length(glm::clamp(origin_, lo, hi) - origin_) < radius;
    }

    Surface::Vertex_index vertex(std::uint32_t v) {
        const auto [it, fresh] = vertex_.try_emplace(v);
        if (fresh) {
            const Vec3f p = mesh_.positions[v];
            it->second = surface_.add_vertex({p.x, p.y, p.z});
        }
        return it->second;
    }

    /// In the order in which CGAL goes round the face.
    typename Paths::Barycentric_coordinates weights(Surface::Face_index face, const Vec3& p) const {
        const auto h = surface_.halfedge(face);
        const auto at = [&](Surface::Vertex_index v) {
            const auto& q = surface_.point(v);
            return Vec3(q.x(), q.y(), q.z());
        };
        const Vec3 a = at(surface_.source(h));
        const Vec3 e1 = at(surface_.target(h)) - a, e2 = at(surface_.target(surface_.next(h))) - a;
        const Vec3 n = glm::cross(e1, e2);
        const double nn = glm::dot(n, n);
        const double b1 = std::clamp(glm::dot(glm::cross(p - a, e2), n) / nn, 0.0, 1.0);
        const double b2 = std::clamp(glm::dot(glm::cross(e1, p - a), n) / nn, 0.0, 1.0 - b1);
        return {1 - b1 - b2, b1, b2};
    }

    const mesh::TriangleMesh& mesh_;
    Vec3 origin_;
    Surface surface_;
    std::unordered_map<std::uint32_t, Surface::Vertex_index> vertex_;
    std::unordered_map<std::uint32_t, Surface::Face_index> face_;
    std::unique_ptr<Paths> paths_;
};

}  // namespace tuft::testing
