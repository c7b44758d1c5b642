#include "mesh/ray_tree.h"

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <cstring>

#include "core/error.h"

namespace tuft::mesh {
namespace {

void check(RTCDevice device, const char* what) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    throw Error(Message("cannot build the search tree of the mesh ({}): {}", what,
                        code == RTC_ERROR_OUT_OF_MEMORY ? Message("out of memory")
                                                        : Message("Embree error {}", static_cast<int>(code))));
}

}  // namespace

RayTree::RayTree(std::span<const Vec3f> positions, std::span<const std::array<std::uint32_t, 3>> triangles) {
    // One builder thread, so that the tree, and with it the choice between equal ray hits, never
    // varies. Embree's own "threads=1" would hold the whole process to one thread for ever.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    device_ = rtcNewDevice("set_affinity=0");
    if (!device_) throw Error("Embree does not start on this machine");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads 16 bytes at every vertex, for which its own buffers are padded and ours are not; triangles
    // it reads where they are.
    if (!triangles.empty()) {
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                                 positions.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                   3 * sizeof(std::uint32_t), triangles.size());
        if (vertices) {
            std::memcpy(vertices, positions.data(), positions.size() * sizeof(Vec3f));
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene_, geometry);
        }
    }
    rtcReleaseGeometry(geometry);
    try {
        check(device_, "points");
        rtcCommitScene(scene_);
        check(device_, "tree");
    } catch (...) {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
        throw;
    }
}

RayTree::~RayTree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

}  // namespace tuft::mesh
