#pragma once

#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// Query table over the root bending moment and the Fixed Shape Method: the tuft's shape for a moment M, rotated in
/// the bending plane until the tip touches the surface. Shapes are large-deflection elastica under a transverse tip
/// load, for any stiffness profile. Source: [Huang2018]; the shapes are exact
/// here.
namespace tuft::brush {

/// One entry, holder frame: x along the axis from the root, y to the bend side; metres.
/// Nodes go from tip (0) to root (n).
struct TableRow {
    double moment = 0;         ///< M at the root, N·m
    double load = 0;           ///< P, N
    Recycled<Vec2> nodes;      ///< P_ib
    Recycled<double> angles;   ///< θ_ib, radians from the axis
    Recycled<double> moments;  ///< m_i, N·m
};

/// Shapes of one tuft, by root moment.
struct QueryTable {
    double length = 0;           ///< m
    double stiffness = 0;        ///< B0, N·m²
    std::vector<TableRow> rows;  ///< rising moment, first row straight
};

/// Returns the table of a preset, with `rows` rows.
QueryTable make_table(const Preset& preset, int rows = 64);

/// Returns the shape at a moment, clamped to the table's range; cubic between rows.
TableRow look_up(const QueryTable& table, double moment);

/// Returns the smallest moment that lifts the tip to the surface, height of the root + `up` · tip >= 0, where `up` is
/// the surface's normal in the holder frame. Returns the table's largest moment when none does.
double touching_moment(const QueryTable& table, double root_height, const Vec2& up);

/// Shape of the tuft on a plane. Lengths in metres, angles in radians.
struct FixedShape {
    double moment = 0;        ///< M, N·m
    double holder_angle = 0;  ///< φ between the holder and the plane
    double tip_angle = 0;     ///< θ of the tip from the plane's normal
    std::vector<Vec2> nodes;  ///< (along the plane, height), tip first at height 0, root at x = 0
    double reaction = 0;      ///< F_re = λ M / max(|x_m - x_0|, 0.1 L), N
    double friction = 0;      ///< μ F_re, N
};

/// Returns the shape for a given moment and root height; the holder's angle follows.
FixedShape fixed_shape(const QueryTable& table, double moment, double root_height, double mu, double lambda = 1);

/// Returns the shape for a given root height and holder angle (a six-degree device); the moment follows. Where the
/// largest moment leaves the tip below the plane, the last row is used.
FixedShape fixed_shape_at_angle(const QueryTable& table, double root_height, double holder_angle, double mu,
                                double lambda = 1);

}  // namespace tuft::brush
