#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/ray_tree.h"
#include "mesh/repair/half_edges.h"

/// \file
/// What the sides of a surface see of the open. Used by `orient` only.
namespace tuft::mesh {

/// Parts of the light of an even sky, from all around, that reach each side of some triangles: 1 on the outside of a
/// convex body.
struct Exposure {
    double front = 0, back = 0;
};

/// Measures exposures on a mesh, which must outlive it.
class ExposureProbe {
  public:
    explicit ExposureProbe(const RawMesh& mesh);

    /// Returns the exposure of `faces`, from `rays` rays to each side, spread evenly over their area and by the cosine
    /// over directions. `turned` [triangles]: their front is against the winding. The same for the same mesh.
    Exposure of(std::span<const std::uint32_t> faces, const std::vector<bool>& turned, int rays) const;

  private:
    bool is_ray_free(const Vec3& from, const Vec3& direction) const;

    const RawMesh& mesh_;
    RayTree tree_;
    double near_ = 0;  ///< metres of a ray's beginning that count as its own triangle
};

}  // namespace tuft::mesh
