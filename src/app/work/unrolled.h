#pragma once

#include <span>
#include <vector>

#include "stroke/journal/entry/samples.h"

/// \file
/// Placements on a model unrolled into a plane, for pictures of a text that runs round it. Any thread.
namespace tuft::app {

/// A frame in the plane.
struct PlaneFrame {
    Vec2 origin{0}, right{1, 0}, down{0, 1};  ///< metres; unit

    /// Returns the plane's point at the point `p` of the frame, metres.
    Vec2 at(const Vec2& p) const { return origin + p.x * right + p.y * down; }
};

/// Returns the placements in the plane of the first, whose frame is the identity. Each one follows the one before: its
/// normal turns by the shortest arc into the normal of that one, and its origin is as far away as in space, in the mean
/// of the directions that both tangent planes see. In one plane this is an isometry. On a cone or a cylinder level rows
/// become arcs and straight lines. A placement that equals the one before has its frame.
std::vector<PlaneFrame> unrolled(std::span<const stroke::Placement> placements);

}  // namespace tuft::app
