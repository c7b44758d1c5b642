#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/repair/half_edges.h"

/// The repaired surface in OpenMesh's half-edge structure. Internal to `mesh`.
namespace tuft::mesh {

class SurfaceTopology {
  public:
    /// Needs a manifold, oriented mesh whose `opposite` agrees with its vertex numbers and
    /// whose vertices have one fan each (see `settle`). Linear time, about 110 bytes per
    /// triangle.
    explicit SurfaceTopology(const RawMesh& mesh);
    ~SurfaceTopology();

    /// Flips the long edge of triangles that are flat within the rounding of float coordinates
    /// (a corner lies on the opposite side), so that the sliver goes and no crack opens.
    /// The texture coordinate of that corner is interpolated on the side. Returns the number
    /// of triangles made sound; `mesh` is changed alike.
    std::size_t turn_flat_triangles(RawMesh& mesh);

    std::size_t n_components() const;
    std::size_t n_border_edges() const;
    /// Border loops: holes, and rims of open sheets.
    std::size_t n_border_loops() const;
    /// [3 n_triangles] as in `TriangleMesh`.
    std::vector<std::uint32_t> neighbours() const;
    /// [3 n_triangles] unit; the mean of the face normals in each run of triangles around the
    /// vertex that is not broken by an edge sharper than `crease_angle` radians, weighted by
    /// the angles at the vertex (Thürmer and Wüthrich 1998).
    std::vector<Vec3f> corner_normals(double crease_angle) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::mesh
