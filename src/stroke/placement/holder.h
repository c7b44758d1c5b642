#pragma once

#include "stroke/placement/placement.h"

/// \file
/// The pose of a holder over one point. Called by placement.h for surfaces and by drawing/plane_ink.h for planes.
namespace tuft::stroke {

/// A point that a holder stands over, and its lean.
struct HolderPose {
    Vec3 normal{0, 0, 1};  ///< unit, of the surface
    Vec3 right{1, 0, 0};   ///< unit, along the surface: first axis of the tilt
    Vec3 down{0, -1, 0};   ///< unit, along the surface: second axis of the tilt
    double depth = 0;      ///< metres of the unbent tip below the surface; negative above it
    Vec2 tilt{0};          ///< radians, towards right, towards down
    double roll = 0;       ///< radians, anticlockwise about the holder's axis: of the ferrule's x from `right`
    double time = 0;       ///< seconds
};

/// Returns the ferrule's pose over `place` (metres, world), by the law of placement.h. `height`: metres of the levelled
/// surface over `place`.
brush::Pose pose_holder(const Vec3& place, double height, const HolderPose& held, const HolderOptions& options);

/// Returns options for a brush over a plane, without tip lag.
HolderOptions holder_options(const brush::Preset& preset);

}  // namespace tuft::stroke
