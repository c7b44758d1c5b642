#pragma once

#include <span>

#include "core/geometry/types.h"

/// \file
/// Oriented bounding boxes for the broad phase of contact.h.
namespace tuft::contact {

/// A box with axes of its own.
struct Obb {
    Vec3 centre{0};  ///< metres
    Mat3 axes{1.0};  ///< columns, unit and orthogonal
    Vec3 half{0};    ///< metres along the columns
};

/// Returns the box along the principal axes of the points, enlarged by `margin` on every side. Source:
/// [Gottschalk1996].
Obb obb_of(std::span<const Vec3> points, double margin = 0);

/// Returns a box along the axes as an oriented one.
Obb obb_of(const Box& box);

/// Returns true when two boxes overlap or touch: test of the 15 separating axes.
bool overlap(const Obb& a, const Obb& b);

/// Returns the eigenvectors of a symmetric matrix as columns, largest eigenvalue first, right-handed.
Mat3 principal_axes(const Mat3& symmetric);

}  // namespace tuft::contact
