#pragma once

#include <optional>
#include <span>
#include <vector>

#include "brush/state/tuft_state.h"

/// \file
/// Times of a path that keep limits of speed and acceleration; the path itself does not change. Called by trajectory.h.
namespace tuft::motion {

/// A pose of the ferrule (position: middle of its mouth) and the expected force there.
struct Waypoint {
    brush::Pose pose;
    Vec3 force{0};                    ///< newtons, of the surface on the tuft, model frame
    std::optional<double> hand_time;  ///< seconds on the hand's clock, in a stroke; `pose.time` is the tool's
};

/// Limits of the tool.
struct Limits {
    double speed = 0.25;      ///< m/s
    double acceleration = 1;  ///< m/s²
    double turn = 1.57;       ///< rad/s, of the tool
};

/// Gives the points new times from 0 on, at rest at both ends. With constant speeds s_i on the segments, of lengths l_i
/// and durations l_i / s_i, the acceleration at a point is the change of velocity over the mean of both durations:
///
///     a_i = (s_i u_i − s_{i−1} u_{i−1}) / ½ (l_i / s_i + l_{i−1} / s_{i−1}),   |a_i| ≤ acceleration.
///
/// Half of it goes to the change of direction u, which bounds both speeds, half to the change of speed, which is met by
/// one pass forwards and one backwards (as [Bobrow1985] do on the phase plane). No segment is faster than
/// `speed`, turns faster than `turn`, or takes less time than `pace` (seconds for each segment, the hand's; empty:
/// none). Segments without length last as long as the hand did or the turn needs, at rest. Linear cost.
void retime(std::vector<Waypoint>& points, const Limits& limits, std::span<const double> pace = {});

/// Returns the angle between two rotations, radians.
double angle_between(const Quat& a, const Quat& b);

}  // namespace tuft::motion
