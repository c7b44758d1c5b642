#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atlas/seams/chart_mesh.h"

/// \file
/// Triangles of a chart in their own planes: the isometric reference of the flattening.
namespace tuft::atlas {

// A triangle flatter than this part of its longest edge is laid out as if it were this high.
inline constexpr double kMinHeight = 1e-4;

/// The triangle in its own plane, counter-clockwise, first corner at the origin.
struct Reference {
    std::array<Vec2, 3> corner;      ///< in the unit of the chart
    std::array<double, 3> half_cot;  ///< half the cotangent of the angle facing edge k -> k + 1
    double area = 0;                 ///< of the triangle
};

/// Returns triangle `t` in its own plane, at least `min_height` of its longest edge high.
Reference reference_triangle(const ChartMesh& chart, std::size_t t, double min_height = kMinHeight);

/// Returns the area of a triangle in the plane of `uv`, positive where it is counter-clockwise.
inline double signed_area(const std::array<std::uint32_t, 3>& f, const std::vector<Vec2>& uv) {
    const Vec2 a = uv[f[1]] - uv[f[0]], b = uv[f[2]] - uv[f[0]];
    return 0.5 * (a.x * b.y - a.y * b.x);
}

}  // namespace tuft::atlas
