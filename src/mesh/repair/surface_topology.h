#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/repair/half_edges.h"

/// \file
/// The repaired surface in OpenMesh's half-edge structure. Used by `build_surface` only.
namespace tuft::mesh {

/// Half-edges of a repaired mesh, for its last corrections and its counts.
class SurfaceTopology {
  public:
    /// Preconditions: the mesh is manifold and oriented, `opposite` agrees with its vertex numbers, and every
    /// vertex has one fan (see `settle`). Cost: linear time, about 110 bytes per triangle.
    explicit SurfaceTopology(const RawMesh& mesh);
    ~SurfaceTopology();

    /// Flips the long edge of triangles that are flat within the rounding of float coordinates (a corner lies on
    /// the opposite side). This removes the sliver without a crack. The texture coordinate of that corner is
    /// interpolated on the side. `mesh` is changed alike. Returns the number of repaired triangles.
    std::size_t turn_flat_triangles(RawMesh& mesh);

    /// Counts of the surface as it is now.
    std::size_t n_components() const;
    std::size_t n_border_edges() const;
    /// Border loops: holes, and rims of open sheets.
    std::size_t n_border_loops() const;
    /// [3 n_triangles] as in `TriangleMesh`.
    std::vector<std::uint32_t> neighbours() const;
    /// [3 n_triangles] unit. Mean of the face normals round a vertex, weighted by the angles at the vertex
    /// [Thurmer1998]. The mean is taken over each run of triangles without an edge sharper than `crease_angle`
    /// radians.
    std::vector<Vec3f> corner_normals(double crease_angle) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::mesh
