#pragma once

#include "stroke/placement/placement.h"

/// A holder over one place.
namespace tuft::stroke {

/// What a holder is held over, and how.
struct HolderPose {
    Vec3 normal{0, 0, 1};  ///< unit, of the surface
    Vec3 right{1, 0, 0};   ///< unit, along it: what a tilt's axes are
    Vec3 down{0, -1, 0};
    double depth = 0;  ///< metres of the unbent tip below the surface; above it: negative
    Vec2 tilt{0};      ///< radians, towards right, towards down
    double roll = 0;   ///< radians, anticlockwise about the holder's axis: of the ferrule's x from `right`
    double time = 0;
};

/// The ferrule over a place, as `hold` has it; `height`: metres of the ground over that place.
brush::Pose pose_holder(const Vec3& place, double height, const HolderPose& held, const HolderOptions& options);

/// Options for a brush over a plane, without a tip_lag.
HolderOptions holder_options(const brush::Preset& preset);

}  // namespace tuft::stroke
