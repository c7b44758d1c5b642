#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/geometry/types.h"

/// \file
/// Exact rasterisation of UV triangles. UVs are rounded to a grid of 2⁻²⁴, on which floats in [0, 1] lie, so
/// triangles that share an edge never both own a texel centre.
namespace tuft::atlas {

inline constexpr double kUvGrid = 16777216;  ///< grid steps per unit of UV, 2²⁴

/// Returns true when both coordinates are finite.
inline bool is_finite(const Vec2f& uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y);
}

/// A finite UV in grid steps; [−8, 8] at most.
inline std::array<std::int64_t, 2> uv_grid(const Vec2f& uv) {
    const auto step = [](float x) {
        return static_cast<std::int64_t>(std::llround(std::clamp(double{x}, -8.0, 8.0) * kUvGrid));
    };
    return {step(uv.x), step(uv.y)};
}

/// Twice the signed area in grid steps, exact.
inline std::int64_t twice_area(const std::array<std::int64_t, 2>& a, const std::array<std::int64_t, 2>& b,
                               const std::array<std::int64_t, 2>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// As `raster_rows`, of a triangle with positive area in grid steps; `Wide` holds what comes up.
template <class Wide, class Run>
void raster_rows_in(const std::array<std::array<std::int64_t, 2>, 3>& p, std::uint32_t size, Run&& run) {
    // In units of 1 / (2 size) of a grid step, texel i has its centre at (2i + 1) 2²⁴.
    const auto n = static_cast<std::int64_t>(size);
    constexpr auto grid = static_cast<std::int64_t>(kUvGrid);
    const auto floor_div = [](Wide a, Wide b) { return a >= 0 ? a / b : -((-a + b - 1) / b); };
    const auto [y_lo, y_hi] = std::minmax({p[0][1], p[1][1], p[2][1]});
    const auto first_row = static_cast<std::int64_t>(std::max<Wide>(0, floor_div(Wide{y_lo} * 2 * n - grid, 2 * grid)));
    const auto last_row =
        static_cast<std::int64_t>(std::min<Wide>(n - 1, floor_div(Wide{y_hi} * 2 * n - grid, 2 * grid) + 1));
    for (std::int64_t j = first_row; j <= last_row; ++j) {
        const Wide centre = Wide{2 * j + 1} * grid;
        Wide first = 0, last = n - 1;
        for (int k = 0; k < 3 && first <= last; ++k) {
            const auto& a = p[k];
            const auto& b = p[(k + 1) % 3];
            const std::int64_t dx = b[0] - a[0], dy = b[1] - a[1];
            const bool owns = dy < 0 || (dy == 0 && dx > 0);  // a centre on the edge is inside
            // Inside where value(i) = start + slope i is positive (or zero, if owned).
            const Wide start =
                Wide{dx} * (centre - Wide{a[1]} * 2 * n) - Wide{dy} * (grid - Wide{a[0]} * 2 * n) - (owns ? 0 : 1);
            const Wide slope = -Wide{dy} * 2 * grid;
            if (slope == 0) {
                if (start < 0) last = -1;
            } else if (slope > 0) {
                first = std::max(first, -floor_div(start, slope));
            } else {
                last = std::min(last, floor_div(start, -slope));
            }
        }
        if (first <= last)
            run(static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
    }
}

/// Calls run(row, first, last) for every row of texels of a size × size page whose
/// centres first..last lie in the triangle. A centre on an edge belongs to one side
/// only. Orientation does not matter; triangles without area, or with a corner that is not
/// finite, have no texels.
template <class Run>
void raster_rows(const std::array<Vec2f, 3>& uv, std::uint32_t size, Run&& run) {
    if (!std::all_of(uv.begin(), uv.end(), is_finite)) return;
    std::array<std::array<std::int64_t, 2>, 3> p{uv_grid(uv[0]), uv_grid(uv[1]), uv_grid(uv[2])};
    const std::int64_t area = twice_area(p[0], p[1], p[2]);
    if (area == 0) return;
    if (area < 0) std::swap(p[1], p[2]);
    // Sides times places stay within 2⁶² where they are products of less than 2⁶⁰ each: a division
    // of 64 bits takes a third of one of 128.
    std::int64_t side = 0, far = static_cast<std::int64_t>(kUvGrid);
    for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 2; ++axis) {
            side = std::max(side, std::abs(p[(k + 1) % 3][axis] - p[k][axis]));
            far = std::max(far, std::abs(p[k][axis]));
        }
    // A centre and a corner are 4 n far apart at most, and there are two such products.
    if (side < (std::int64_t{1} << 59) / far / (4 * static_cast<std::int64_t>(size) + 4))
        raster_rows_in<std::int64_t>(p, size, run);
    else
        raster_rows_in<__int128>(p, size, run);
}

}  // namespace tuft::atlas
