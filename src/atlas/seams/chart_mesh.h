#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/seams/half_edges.h"

/// \file
/// Mesh of one chart: triangles glued over every edge that is no seam. Used by atlas/flatten and atlas/charts.
namespace tuft::atlas {

/// Triangles of a chart with their own vertices.
struct ChartMesh {
    std::vector<std::uint32_t> triangles;             ///< [n] triangle of the mesh
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< [n] vertices of the chart
    std::vector<std::uint32_t> twin;                  ///< [3n] half-edge of the chart, kNone on its border
    std::vector<Vec3> position;                       ///< [n_vertices] from the chart's first corner, over `unit`
    std::vector<std::uint32_t> loop;                  ///< border vertices in order, when the chart is a disk
    double area = 0;                                  ///< over unit²
    bool disk = false;                                ///< connected, one border, Euler characteristic 1

    std::size_t n_vertices() const { return position.size(); }
};

/// Returns the chart of `triangles` (ascending). `glued` [3 n_triangles of the mesh] is the opposite half-edge,
/// kNone on borders and seams; none may lead out of `triangles`. `place` [n_triangles of the mesh] is a scratch
/// buffer, of which only the chart's triangles are written; without it the call is slower.
ChartMesh make_chart(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> glued,
                     std::vector<std::uint32_t> triangles, double unit, std::span<std::uint32_t> place = {});

/// Triangles of each chart (ascending), charts in the order of their first triangle.
std::vector<std::vector<std::uint32_t>> connected_charts(std::span<const std::uint32_t> glued);

/// Measures of a flattened chart; UVs in the same unit as the positions.
struct FlatCheck {
    bool finite = true;       ///< all UVs are finite
    std::size_t flips = 0;    ///< triangles without positive area
    bool crosses = false;     ///< the border crosses itself
    double l2 = 0, linf = 0;  ///< stretch as the UVs stand, not rescaled
    double stretch_999 = 0;   ///< largest singular value at 99.9 % of the area
    double uv_area = 0;       ///< sum of the signed areas of the triangles

    /// Whether the UVs are those of a valid chart.
    bool sound() const { return finite && flips == 0 && !crosses; }
};

/// `gap`: see `crosses_itself`.
FlatCheck check_flat(const ChartMesh& chart, std::span<const Vec2> uv, double gap = 0);

/// Returns true when the chart's border crosses itself, or two parts of it come nearer to each other than `gap`. Only
/// parts count that are more than 16 gaps apart along the border and twice as far on the surface: nearer ones may be
/// the two sides of a slit. Contact is no crossing. Parts less than `near` of the border's length apart along it are
/// ignored.
bool crosses_itself(const ChartMesh& chart, std::span<const Vec2> uv, double gap, double near = 0);

}  // namespace tuft::atlas
