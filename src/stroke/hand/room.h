#pragma once

#include <optional>

#include "mesh/surface_query.h"

/// Where a flat drawing finds room on a model.
namespace tuft::stroke {

struct Room {
    mesh::SurfacePoint at;    ///< under the drawing's middle
    Vec3 normal{0, 0, 1};     ///< mean over the drawing, unit, towards who looks
    double scale = 1;         ///< of the size that was asked for
};

/// Looks at the model along `look` (unit; z is up, or y where it looks along z) with a grid of 129² rays over its box
/// and takes the place nearest to the box's middle where a rectangle of `size` (across × upright, metres, upright to
/// `look`) sees surface everywhere, in one piece and bent no more than a wide arc of a cylinder (the mean of its
/// normals is 0.85 long or more); gaps of one or two rays, such as shut lines, do not count. The rectangle shrinks by
/// fourth roots of two until there is such a place; nothing where not even a sixteenth of it finds one.
std::optional<Room> find_room(const mesh::SurfaceQuery& query, const Vec3& look, const Vec2& size);

}  // namespace tuft::stroke
