#pragma once

#include "haptic/device.h"

/// \file
/// Where the arm's space lies in the world: turned, scaled, shifted, re-gripped by a clutch. `Servo` uses it.
namespace tuft::haptic {

/// world = offset + rotation · scale · device.
struct Workspace {
    Vec3 offset{0};             ///< m, world
    Quat rotation{1, 0, 0, 0};  ///< turns the arm's frame into the world, with the view or fixed
    double scale = 1;           ///< metres of the brush per metre of the arm

    Vec3 to_world(const Vec3& device) const { return offset + rotation * (scale * device); }
    /// A force is not scaled: the stiffness is, see `coupling_of`.
    Vec3 to_device(const Vec3& force) const { return glm::conjugate(rotation) * force; }
    Vec3 place_in_device(const Vec3& world) const { return glm::conjugate(rotation) * (world - offset) / scale; }
    /// The same space, shifted so that the arm at `device` is at `world`: the end of a clutch, or of a turn of the
    /// view.
    Workspace regripped(const Vec3& device, const Vec3& world) const {
        Workspace w = *this;
        w.offset += world - to_world(device);
        return w;
    }
};

}  // namespace tuft::haptic
