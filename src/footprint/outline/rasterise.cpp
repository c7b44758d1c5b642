#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "footprint/outline/outline.h"
#include "footprint/outline/section_outline.h"

namespace tuft::footprint {
namespace {

constexpr int kMaxCells = 4096;  // along a side

/// What edges add to the covered part along a row: to their own cell the area to their
/// right, from the next cell on all of the height they cross.
struct BorderCell {
    int row, column;
    float area, height;
};

/// Collects the border cells of outlines; costs grow with the border, not with the area.
struct Border {
    int height;                  ///< rows
    Recycled<BorderCell> cells;  ///< as drawn

    /// Part of an edge inside one cell.
    void add_in_cell(int i, int j, double x0, double x1, double dy) {
        const auto area = static_cast<float>(dy * (1 - (0.5 * (x0 + x1) - i)));
        const auto whole = static_cast<float>(dy);
        if (!cells.empty() && cells.back().row == j && cells.back().column == i) {
            cells.back().area += area;
            cells.back().height += whole;
        } else {
            cells.push_back({j, i, area, whole});
        }
    }

    /// Part of an edge inside one row of cells.
    void add_in_row(int j, double x0, double x1, double dy) {
        const int first = static_cast<int>(x0), last = static_cast<int>(x1);  // not negative
        if (first == last) {
            add_in_cell(first, j, x0, x1, dy);
            return;
        }
        const double per_x = dy / (x1 - x0);
        const int step = last > first ? 1 : -1;
        double x = x0;
        for (int i = first; i != last; i += step) {
            const double border = step > 0 ? i + 1 : i;
            add_in_cell(i, j, x, border, per_x * (border - x));
            x = border;
        }
        add_in_cell(last, j, x, x1, per_x * (x1 - x));
    }

    void add(const Vec2& p, const Vec2& q) {
        if (p.y == q.y) return;
        const bool up = q.y > p.y;
        const Vec2 &lo = up ? p : q, &hi = up ? q : p;
        const double slope = (hi.x - lo.x) / (hi.y - lo.y);
        double y = lo.y, x = lo.x;
        for (int j = static_cast<int>(lo.y); y < hi.y; ++j) {
            const double next = std::min(hi.y, double(j) + 1);
            const double x_next = next == hi.y ? hi.x : lo.x + slope * (next - lo.y);
            add_in_row(j, x, x_next, up ? next - y : y - next);
            y = next;
            x = x_next;
        }
    }

    /// Coverage of all cells; outlines of one sense cover positively, all together at most once. `out`: zeros.
    void resolve(int width, std::uint8_t* out) const {
        // By column, then by row: cells of a column stay in the order in which they were drawn.
        const std::size_t n = cells.size();
        Recycled<std::uint32_t> by_column(n), by_row(n), start(static_cast<std::size_t>(std::max(width, height)) + 2);
        const auto put_in_order = [&](auto&& key_of, int keys, auto&& cell_at, Recycled<std::uint32_t>& order) {
            std::fill_n(start.begin(), keys + 2, 0u);
            for (const BorderCell& c : cells) ++start[key_of(c) + 2];
            for (int k = 0; k < keys; ++k) start[k + 2] += start[k + 1];
            for (std::size_t k = 0; k < n; ++k) {
                const std::uint32_t cell = cell_at(k);
                order[start[key_of(cells[cell]) + 1]++] = cell;
            }
        };
        put_in_order([](const BorderCell& c) { return c.column; }, width,
                     [](std::size_t k) { return static_cast<std::uint32_t>(k); }, by_column);
        put_in_order([](const BorderCell& c) { return c.row; }, height, [&](std::size_t k) { return by_column[k]; },
                     by_row);
        // Row j holds the cells from start[j] to start[j + 1].
        for (int j = 0; j < height; ++j) {
            const std::uint32_t *next = by_row.data() + start[j], *const last = by_row.data() + start[j + 1];
            std::uint8_t* line = out + static_cast<std::size_t>(j) * width;
            float height_before = 0;
            int column = 0;
            while (next < last) {
                const int at = cells[*next].column;
                if (const std::uint8_t inside = level(height_before); inside != 0 && column < at)
                    std::memset(line + column, inside, static_cast<std::size_t>(at - column));
                float area = height_before;
                for (; next < last && cells[*next].column == at; ++next) {
                    const BorderCell& cell = cells[*next];
                    area += cell.area;
                    height_before += cell.height;
                }
                line[at] = level(area);
                column = at + 1;
            }
            // What is left of the sum beyond the last border is rounding.
        }
    }

    static std::uint8_t level(float covered) {
        return static_cast<std::uint8_t>(std::min(std::abs(covered), 1.0f) * 255.0f + 0.5f);
    }
};

}  // namespace

Footprint disc(const Frame& frame, std::uint32_t triangle, double radius, double cell) {
    Footprint result;
    result.frame = frame;
    result.triangle = triangle;
    result.cell = cell;
    const double half = std::ceil(radius / cell) + 2;
    if (!(half >= 2 && 2 * half <= kMaxCells))
        throw Error(
            Message("a disc of {} mm does not fit into {} texels: use a larger texel size", 1e3 * radius, kMaxCells));
    result.width = result.height = static_cast<int>(2 * half);
    result.lo = Vec2{-half * cell};
    result.radius = radius + cell;
    result.coverage.reserve(static_cast<std::size_t>(result.width) * result.height);
    for (int j = 0; j < result.height; ++j) {
        for (int i = 0; i < result.width; ++i) {
            const double out = glm::length(Vec2(i, j) + 0.5 - half) - radius / cell;
            result.coverage.push_back(static_cast<std::uint8_t>(std::clamp(0.5 - out, 0.0, 1.0) * 255 + 0.5));
        }
    }
    return result;
}

Footprint rasterise_polygons(std::span<const Polygon> polygons, const Frame& frame, std::uint32_t triangle,
                             double cell) {
    Footprint result;
    result.frame = frame;
    result.triangle = triangle;
    result.cell = cell;
    Vec2 lo{1e9}, hi{-1e9};
    double radius2 = 0;
    for (const Polygon& polygon : polygons) {
        for (const Vec2& p : polygon) {
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
            radius2 = std::max(radius2, glm::dot(p, p));
        }
    }
    result.radius = std::sqrt(radius2);
    if (!(lo.x <= hi.x && lo.y <= hi.y)) return result;
    const double side = std::max(hi.x - lo.x, hi.y - lo.y);
    if (!std::isfinite(side / cell))
        throw Error(Message("a footprint {} mm wide has no picture with cells of {} mm", 1e3 * side, 1e3 * cell));
    while (side > (kMaxCells - 4) * cell) cell *= 2;  // two cells of border on each side
    const Vec2 first = glm::floor(lo / cell) - 1.0, last = glm::floor(hi / cell) + 2.0;
    const Vec2 size = last - first;
    result.cell = cell;
    result.lo = first * cell;
    result.width = static_cast<int>(size.x);
    result.height = static_cast<int>(size.y);
    result.radius += 2 * cell;
    Border border{.height = result.height, .cells = {}};
    border.cells.reserve(4 * static_cast<std::size_t>(result.width + result.height));
    Polygon curve;
    for (const Polygon& polygon : polygons) {
        curve.clear();
        for (const Vec2& p : polygon) curve.push_back(p / cell - first);
        for (std::size_t k = 0; k + 1 < curve.size(); ++k) border.add(curve[k], curve[k + 1]);
        if (!curve.empty()) border.add(curve.back(), curve.front());
    }
    result.coverage.resize(static_cast<std::size_t>(result.width) * result.height);
    border.resolve(result.width, result.coverage.data());
    return result;
}

Footprint rasterise(std::span<const Outline> outlines, const Frame& frame, std::uint32_t triangle, double cell) {
    Recycled<Polygon> curves;
    curves.reserve(outlines.size());
    for (const Outline& o : outlines) curves.push_back(curve_points(o));
    return rasterise_polygons(curves, frame, triangle, cell);
}

}  // namespace tuft::footprint
