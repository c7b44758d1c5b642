#pragma once

#include <algorithm>
#include <cmath>

#include "haptic/device/device.h"

/// \file
/// Where the arm's space lies in the world: turned, scaled, shifted, re-gripped by a clutch. `Servo` uses it.
namespace tuft::haptic {

/// world = offset + rotation · scale · device.
struct Workspace {
    Vec3 offset{0};             ///< m, world
    Quat rotation{1, 0, 0, 0};  ///< turns the arm's frame into the world, with the view or fixed
    double scale = 1;           ///< metres of the brush per metre of the arm
    Quat grip{1, 0, 0, 0};      ///< rotation of the arm's grip in which the brush is upright, from calibration

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
    /// One period of the way to `goal`, by at most 0.5 mm and 4 mrad: the hand feels a view that turns 60 times a
    /// second as a steady motion. Scale and grip are those of `goal`.
    Workspace approached(const Workspace& goal) const {
        constexpr double kMove = 5e-4, kTurn = 4e-3;  // m, rad
        const double turn = 2 * std::acos(std::min(1.0, std::abs(glm::dot(rotation, goal.rotation))));
        const double move = glm::distance(offset, goal.offset);
        const double part = std::min({1.0, move > kMove ? kMove / move : 1.0, turn > kTurn ? kTurn / turn : 1.0});
        if (part == 1) return goal;
        return {glm::mix(offset, goal.offset, part), glm::normalize(glm::slerp(rotation, goal.rotation, part)),
                goal.scale, goal.grip};
    }
};

}  // namespace tuft::haptic
