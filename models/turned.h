#pragma once

#include <functional>
#include <span>
#include <vector>

#include "shape.h"

/// Surfaces of revolution from an outline in the half plane (radius, height),
/// millimetres. A pen draws the outline from the axis under the piece outwards, up
/// the outside, over the lip and down the inside back to the axis: the material
/// lies to the left of the pen.
namespace tuft::models {

using Outline = std::vector<Vec2>;

/// The functions below append to an outline, from where its pen is.
void add_line(Outline& outline, Vec2 end, int n_steps = 1);
void add_curve(Outline& outline, Vec2 handle_a, Vec2 handle_b, Vec2 end, int n_steps);  ///< Bézier
void add_half_round(Outline& outline, Vec2 end, int n_steps);                           ///< half circle, turning left

/// Appends a smooth curve through `keys`: the clamped cubic spline over chord
/// length, with the given directions (any length) at its two ends.
void add_spline(Outline& outline, std::span<const Vec2> keys, Vec2 first_direction, Vec2 last_direction, int n_steps);

/// The points of `outer`, backwards, each moved to the left of the pen by
/// `thickness(t)`; t is the part of the length of `outer` before the point.
Outline inner_side(std::span<const Vec2> outer, const std::function<double(double t)>& thickness);

/// Turns the outline about the z axis in `n_around` steps; points on the axis
/// become one vertex, the rest is two triangles per step.
Shape turn(std::span<const Vec2> outline, int n_around);

/// As `turn`, but an outline that never meets the axis and is joined end to start (a ring).
Shape turn_ring(std::span<const Vec2> outline, int n_around);

}  // namespace tuft::models
