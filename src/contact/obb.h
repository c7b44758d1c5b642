#pragma once

#include <span>

#include "core/geometry/types.h"

/// Oriented boxes for the broad phase.
namespace tuft::contact {

struct Obb {
    Vec3 centre{0};  ///< metres
    Mat3 axes{1.0};  ///< columns, unit and orthogonal
    Vec3 half{0};    ///< metres along the columns
};

/// Box along the principal axes of the points, grown by `margin` on every side.
/// Source: Gottschalk, Lin and Manocha 1996.
Obb obb_of(std::span<const Vec3> points, double margin = 0);

Obb obb_of(const Box& box);

/// Whether two boxes meet: the test of the 15 separating axes. Boxes that only touch meet.
bool overlap(const Obb& a, const Obb& b);

/// Eigenvectors of a symmetric matrix as columns, largest eigenvalue first, right-handed.
Mat3 principal_axes(const Mat3& symmetric);

}  // namespace tuft::contact
