#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/geometry/types.h"

struct RTCDeviceTy;
struct RTCSceneTy;

/// \file
/// Embree's tree of triangles. Inside `mesh` only: query/surface_query.h and repair/exposure.h are made of it.
namespace tuft::mesh {

/// Owns a device and a scene with one geometry. Precondition: every index of a triangle is in range, points are finite.
/// Triangles stay where they are and must outlive it; positions are copied. The same mesh gives the same tree. Throws
/// `Error` where memory is short. Any thread may query.
class RayTree {
  public:
    RayTree(std::span<const Vec3f> positions, std::span<const std::array<std::uint32_t, 3>> triangles);
    ~RayTree();
    RayTree(const RayTree&) = delete;
    RayTree& operator=(const RayTree&) = delete;

    RTCSceneTy* scene() const { return scene_; }

  private:
    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* scene_ = nullptr;
};

}  // namespace tuft::mesh
