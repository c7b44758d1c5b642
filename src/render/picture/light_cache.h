#pragma once

#include <cstdint>
#include <vector>

#include "mesh/query/surface_query.h"
#include "render/picture/material.h"
#include "render/picture/studio.h"

/// \file
/// Indirect light: a radiosity solution on small patches, one per voxel and facing direction. Pictures use it only
/// for light that a surface reflects.
namespace tuft::render {

/// Scene for ray tracing; the references must outlive it.
struct Scene {
    const mesh::TriangleMesh& mesh;
    const mesh::SurfaceQuery& query;
    const MaterialReader& material;
    Studio studio;
    float offset = 1e-6f;  ///< metres that secondary rays start above the surface
};

/// Unit normal of the flat triangle.
Vec3f face_normal(const mesh::TriangleMesh& mesh, std::uint32_t triangle);

/// Light of the boxes on a face at p (irradiance over π). `samples`: per box.
Vec3f direct_light(const Scene& scene, const Vec3f& p, const Vec3f& n, const std::array<int, 3>& samples,
                   const Vec2f& shift);

/// Light that surfaces throw onto each other: radiosity on one patch for each voxel and facing direction.
class LightCache {
  public:
    /// What stays of the work: nothing more than the solution, or what `relight` needs (16 bytes for each of some 60
    /// links of a patch).
    enum class Retain { solution, links };

    /// Solves it; deterministic for any thread count. Cost: about 1 s of one core.
    explicit LightCache(const Scene& scene, Retain retain = Retain::solution);

    /// Solves it for the lights that `scene` has now. Surfaces and their colours stay those of the constructor, which
    /// retained its links. The solution is that of a new cache up to rounding. Cost: a third.
    void relight(const Scene& scene);

    /// Light on the object at p with normal n, interpolated between patches.
    Vec3f object_light(const Vec3f& p, const Vec3f& n) const;
    /// The same from the nearest patch; move p by up to half a `voxel` to interpolate by chance.
    Vec3f nearest_light(const Vec3f& p, const Vec3f& n) const;
    /// Light on the floor at (x, y), object in place.
    Vec3f floor_light(float x, float y) const;
    /// The same without the object.
    Vec3f open_floor_light(float x, float y) const;

    float voxel() const { return voxel_; }

  private:
    struct Patch {
        Vec3f p{0}, n{0};
        Vec3f light{0};
    };
    struct Link {
        std::uint32_t patch;  ///< or kFloorLink + grid cell
        Vec3f albedo;
    };
    static constexpr std::uint32_t kFloorLink = 1u << 31;

    std::uint64_t key(const Vec3f& p, int side) const;
    std::uint32_t find(std::uint64_t key) const;
    void insert(const Vec3f& p, const Vec3f& n);
    void seed_patches(const Scene& scene);
    void seed_floor(const Scene& scene);
    std::size_t n_nodes() const { return patches_.size() + floor_.size(); }
    Patch node(const Scene& scene, std::size_t index) const;
    Vec3f link_patch(const Scene& scene, const Patch& at, std::size_t index, std::vector<Link>& links) const;
    void link_nodes(const Scene& scene);
    void solve(const Scene& scene);
    Vec3f read_floor(const std::vector<Vec3f>& grid, float x, float y) const;

    float voxel_ = 1;
    Vec3f origin_{0};
    std::vector<Patch> patches_;
    std::vector<std::uint32_t> table_;  ///< open addressing: patch index or kNone
    std::vector<std::uint64_t> keys_;
    Vec3f mean_{0};
    float floor_half_ = 1;
    Vec2f floor_centre_{0};
    std::vector<Vec3f> floor_, open_floor_;  ///< light at the points of a square grid
    std::vector<std::vector<Link>> links_;   ///< [n_nodes] of patches, then of the floor's points
    std::vector<Vec3f> dome_;                ///< [n_nodes] light of the dome
    float dome_scale_ = 1;                   ///< of the studio in which it was found
};

}  // namespace tuft::render
