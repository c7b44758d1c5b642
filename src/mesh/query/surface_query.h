#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/triangle_mesh.h"

/// \file
/// Ray and closest-point queries on a mesh. `contact`, `stroke`, `render` and `app` use them.
namespace tuft::mesh {

/// Hit of `SurfaceQuery::trace`: the triangle (kNone: a miss), the barycentric weights of its corners 1 and 2, and
/// the distance along the ray in metres.
struct RayHit {
    std::uint32_t triangle = kNone;
    float b1 = 0, b2 = 0;
    float distance = 0;
};

/// A vertex near a point; its normal is the area-weighted mean over its triangles.
struct NearVertex {
    std::uint32_t index = kNone;
    double distance = 0;   ///< metres
    Vec3 position{0};      ///< metres
    Vec3 normal{0, 0, 1};  ///< unit
};

/// Ray and closest-point queries by an Embree BVH. Stores a reference to the mesh: the mesh must outlive the object
/// and must not change. Construction takes about 0.25 s per million triangles. Queries are thread-safe.
class SurfaceQuery {
  public:
    explicit SurfaceQuery(const TriangleMesh& mesh);
    /// Of these triangles alone, [n] indices in ascending order: the others are as if they were not there. Answers
    /// have the indices of the mesh, and the bits of a query of all triangles where that meets these.
    SurfaceQuery(const TriangleMesh& mesh, std::vector<std::uint32_t> triangles);
    ~SurfaceQuery();
    SurfaceQuery(SurfaceQuery&&) noexcept;
    SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

    /// Returns the exact closest point within `max_distance` metres of `p`, or nothing. A small `max_distance` is
    /// faster: 1–3 µs near the surface.
    std::optional<SurfacePoint> closest_point(const Vec3& p,
                                              double max_distance = std::numeric_limits<double>::infinity()) const;

    /// Returns the `k` vertices nearest to `p` among those that triangles use, nearest first. Returns fewer where
    /// there are fewer within `max_distance` metres.
    std::vector<NearVertex> nearest_vertices(const Vec3& p, int k,
                                             double max_distance = std::numeric_limits<double>::infinity()) const;

    /// Returns the first hit at a distance in [t_min, t_max]; `direction` has unit length. Both sides of a triangle
    /// count.
    std::optional<SurfacePoint> ray(const Vec3& origin, const Vec3& direction, double t_min = 0,
                                    double t_max = std::numeric_limits<double>::infinity()) const;

    /// Returns true when a triangle intersects the ray within [t_min, t_max].
    bool occluded(const Vec3& origin, const Vec3& direction, double t_min, double t_max) const;

    /// `ray` and `occluded` in single precision and without the surface point, for pictures
    /// (relative error of the distance about 1e-6).
    RayHit trace(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) const;
    bool blocked(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) const;

    /// Returns the mesh that the queries are on.
    const TriangleMesh& mesh() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::mesh
