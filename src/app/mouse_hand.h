#pragma once

#include <optional>
#include <vector>

#include "brush/preset.h"
#include "mesh/surface_query.h"
#include "stroke/placement.h"

namespace tuft::app {

struct HandSettings {
    double pressure = 0.5;        ///< 0–1 of the working depth at rest
    double speed_effect = 0.5;    ///< part of the pressure lost at `fast`
    double fast = 0.25;           ///< m/s
    double smoothing = 0.03;      ///< seconds of the low-pass on position
};

/// Makes a mouse hold a brush: the cursor's point on the surface, pressure from speed
/// (a fast mouse presses less, as a hand does), a soft landing and a soft lift.
class MouseHand {
  public:
    MouseHand(const mesh::SurfaceQuery& surface, const brush::Preset& preset, const HandSettings& settings);

    /// Cursor ray at a time in seconds since the button went down. Returns the poses that
    /// follow; none while the ray misses the model.
    std::vector<brush::Pose> move(const Vec3& origin, const Vec3& direction, double time);
    /// The hand lifts off.
    std::vector<brush::Pose> lift(double time);

  private:
    brush::Pose pose_at(const Vec3& point, const Vec3& normal, double pressure, double time) const;

    const mesh::SurfaceQuery& surface_;
    stroke::HoldOptions hold_;
    HandSettings settings_;
    bool down_ = false;
    Vec3 point_{0}, normal_{0, 0, 1};
    double pressure_ = 0, time_ = 0, speed_ = 0;
};

}  // namespace tuft::app
