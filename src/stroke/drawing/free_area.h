#pragma once

#include <optional>
#include <string_view>

#include "mesh/query/surface_query.h"

/// \file
/// Where on a model a person would put a drawing: sides of a model, and the largest calm area
/// of one.
namespace tuft::stroke {

/// A side of a model that stands with z up and shows its front to −y; left and right as seen from
/// there.
enum class Side { front, back, left, right, top, bottom, inside };

/// "front", "back", "left", "right", "top", "bottom", "inside", and back; nothing for another name.
std::string_view side_name(Side side);
std::optional<Side> side_named(std::string_view name);

/// Unit direction in which a person looks at a side; at the inside from above.
Vec3 look_at_side(Side side);

/// The side of a model that a drawing goes to when nothing says where: the front; the top of what
/// lies flat (less than a quarter as high as it is wide).
Side usual_side(const Box& bounds);

/// Part of a free area that a drawing of another size takes, and parts between which it stays as it
/// is.
inline constexpr double kUsualPart = 0.6, kLeastPart = 0.15, kMostPart = 0.9;

/// A rectangle, seen along a side's direction, that a drawing can lie in.
struct FreeArea {
    mesh::SurfacePoint at;  ///< under its middle
    Vec3 normal{0, 0, 1};   ///< mean over it, unit, towards the person
    Vec2 size{0};           ///< metres across and upright, as seen
};

/// The largest calm rectangle of a side.
///
/// Appearance at the model with a grid of 129² rays over its box. A ray is free that sees the surface,
/// less than 70° from facing it, without a step to its neighbours; at the inside, with walls around
/// it in six of eight directions. Gaps of one or two rays, such as shut lines, do not count. A
/// rectangle of `aspect` (width over height, held to 1/32–32) of free rays bends no more than a wide
/// arc of a cylinder: the mean of its normals is 0.85 long or more. Surface is calm where normals
/// vary little over five rays; a rectangle on rough surface counts as if it was smaller, by up to
/// two thirds. Of equally large ones, the middle of the largest group is taken. Nothing where not
/// even a 32nd of the view is free. About 0.1 s.
std::optional<FreeArea> find_free_area(const mesh::SurfaceQuery& query, Side side, double aspect);

}  // namespace tuft::stroke
