#pragma once

#include <optional>
#include <string_view>

#include "mesh/query/surface_query.h"

/// \file
/// Default place of a drawing: sides of a model, and the largest calm area of a side. Called by `tuft paint` and by the
/// studio.
namespace tuft::stroke {

/// A side of a model with z up and its front towards −y; left and right as seen from there.
enum class Side { front, back, left, right, top, bottom, inside };

/// Returns the name of the constant.
std::string_view side_name(Side side);
/// Returns the side of that name; nothing for another name.
std::optional<Side> side_named(std::string_view name);

/// Returns the unit direction in which a person looks at a side; at the inside from above.
Vec3 look_at_side(Side side);

/// Returns the default side of a drawing: the front; the top of a flat model, less than a quarter as high as wide.
Side usual_side(const Box& bounds);

/// Part of a free area that a drawing is scaled to, and range of parts in which its size is retained.
inline constexpr double kUsualPart = 0.6, kLeastPart = 0.15, kMostPart = 0.9;

/// A rectangle for a drawing, in the view of a side.
struct FreeArea {
    mesh::SurfacePoint at;  ///< under its centre
    Vec3 normal{0, 0, 1};   ///< mean over it, unit, towards the viewer
    Vec2 size{0};           ///< width and height in the view, metres
};

/// Finds the largest calm rectangle of a side.
///
/// Casts 129² parallel rays over the model's box. Gaps of one or two rays, such as shut lines, are ignored. Through the
/// depths within two rays (of the longer side of a cell) of each ray a plane is laid by least squares, twice: it gives
/// the smoothed depth, then the normal. So noise of a scan counts by its mean over some 25 rays, not by triangles. A
/// ray is free where that normal is within 70° of it, without a step to its neighbours; at the inside also with walls
/// around it in six of eight directions. Roughness of a ray is
///
///     1 − |mean of the normals around| + max(0, r − 2 q)
///
/// r: mean square distance of the depths from the plane, squares of a cell, with gaps taken half a cell deep. q: lower
/// quartile of r over the view, the noise. A roughness above 0.1, such as at a handle, counts 2 more.
///
/// A rectangle has the given `aspect` (width over height, clamped to 1/32–32), free rays only, and |mean of its
/// normals| ≥ 0.85: no more bent than a wide arc of a cylinder. It is worth its scale / (1 + mean roughness / 0.08). Of
/// rectangles that are worth as much within 3 %, the middle one of the largest group is taken. A
/// ray is mirrored where the other half of the view agrees with it to a cell and four times the noise. Where 90 % of
/// the rays are, the best rectangle on the middle line is taken if it is worth at least a third of the best of all.
/// From 90 to 75 % that part rises from a third to all. Returns nothing where less than 1/32 of the view is free. Cost:
/// about 0.1 s.
std::optional<FreeArea> find_free_area(const mesh::SurfaceQuery& query, Side side, double aspect);

}  // namespace tuft::stroke
