#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/types.h"

/// \file
/// What the servo asks the solver, and what the solver answers. Plain data without memory of its own, so that it
/// passes between threads by a copy.
namespace tuft::haptic {

/// A pose of the tuft's root to be solved, world frame.
struct RootPose {
    std::uint64_t tick = 0;     ///< number of the servo's period
    Vec3 position{0};           ///< y, m: the virtual root, not the arm
    Quat rotation{1, 0, 0, 0};  ///< of the holder; the tuft points along rotation * (0, 0, −1)
    std::uint32_t buttons = 0;  ///< of the grip, one bit each
    /// Period in which the brush was last taken up in the air. Another one than that of the pose before: the hair
    /// comes from elsewhere.
    std::uint64_t taken_up = 0;
};

/// The root y must keep normal · y >= height: ferrule or handle would pass the surface beyond.
struct RootBound {
    Vec3 normal{0, 0, 1};  ///< unit, out of the object, world
    double height = 0;     ///< m
    Vec3 lever{0};         ///< m, world: from the root to the point that meets the surface
};

/// The state of hair and surface at one pose.
struct HairAnswer {
    static constexpr std::size_t kMostBounds = 12;

    RootPose pose;             ///< that was solved
    Vec3 force{0};             ///< F, N, of the surface on the tuft, world: `brush::TuftState::force`, paste, proximity
    Vec3 moment{0};            ///< τ, N·m, of F about the root
    double stored = 0;         ///< J, elastic energy of hair and contact
    double distance = 1;       ///< m, from the hair to the surface
    bool touching = false;     ///< hair touches
    bool converged = true;     ///< the solve ended within its limits
    std::size_t n_bounds = 0;  ///< of `bounds`
    std::array<RootBound, kMostBounds> bounds;
    double seconds = 0;  ///< of processor time that the solve took
};

/// A pose that was solved, as the stroke takes it.
struct SolvedPose {
    RootPose pose;
    bool touching = false;
};

}  // namespace tuft::haptic
