#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "footprint/outline.h"

namespace tuft::footprint {
namespace {

constexpr int kMaxCells = 4096;  // along a side

/// Change of the covered part from each cell to the next: an edge adds the area to its
/// right to its own cell and the rest of the height it crosses to the one after.
struct Coverage {
    int width, height;          ///< cells
    std::vector<float> change;  ///< [height * (width + 1)]

    Coverage(int w, int h) : width(w), height(h), change(std::size_t(w + 1) * h, 0) {}

    /// Part of an edge inside one cell.
    void add_in_cell(int i, int j, double x0, double x1, double dy) {
        float* at = change.data() + static_cast<std::size_t>(j) * (width + 1) + i;
        const double right = dy * (1 - (0.5 * (x0 + x1) - i));
        at[0] += static_cast<float>(right);
        at[1] += static_cast<float>(dy - right);
    }

    /// Part of an edge inside one row of cells.
    void add_in_row(int j, double x0, double x1, double dy) {
        const int first = static_cast<int>(std::floor(x0)), last = static_cast<int>(std::floor(x1));
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
        for (int j = static_cast<int>(std::floor(lo.y)); y < hi.y; ++j) {
            const double next = std::min(hi.y, double(j) + 1);
            const double x_next = next == hi.y ? hi.x : lo.x + slope * (next - lo.y);
            add_in_row(j, x, x_next, up ? next - y : y - next);
            y = next;
            x = x_next;
        }
    }

    /// Cells of kRows rows from row j on; outlines of one sense cover positively, all together
    /// at most once. Rows are summed side by side: one sum alone would wait for itself.
    static constexpr int kRows = 4;
    void resolve(int j, std::uint8_t* out) const {
        const int n = std::min(kRows, height - j);
        std::array<const float*, kRows> from;
        for (int r = 0; r < kRows; ++r)
            from[r] =
                change.data() + static_cast<std::size_t>(j + std::min(r, n - 1)) * (width + 1);
        std::array<float, kRows> sum{};
        for (int i = 0; i < width; ++i) {
            for (int r = 0; r < kRows; ++r) sum[r] += from[r][i];
            for (int r = 0; r < n; ++r)
                out[static_cast<std::size_t>(r) * width + i] =
                    static_cast<std::uint8_t>(std::min(std::abs(sum[r]), 1.0f) * 255.0f + 0.5f);
        }
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
        throw Error("a disc of " + std::to_string(1e3 * radius) + " mm does not fit into " +
                    std::to_string(kMaxCells) + " texels: use a larger texel size");
    result.width = result.height = static_cast<int>(2 * half);
    result.lo = Vec2{-half * cell};
    result.radius = radius + cell;
    result.coverage.reserve(static_cast<std::size_t>(result.width) * result.height);
    for (int j = 0; j < result.height; ++j) {
        for (int i = 0; i < result.width; ++i) {
            const double out = glm::length(Vec2(i, j) + 0.5 - half) - radius / cell;
            result.coverage.push_back(
                static_cast<std::uint8_t>(std::clamp(0.5 - out, 0.0, 1.0) * 255 + 0.5));
        }
    }
    return result;
}

Footprint rasterise(std::span<const Outline> outlines, const Frame& frame, std::uint32_t triangle,
                    double cell) {
    Footprint result;
    result.frame = frame;
    result.triangle = triangle;
    result.cell = cell;
    std::vector<std::vector<Vec2>> curves;
    Vec2 lo{1e9}, hi{-1e9};
    for (const Outline& o : outlines) {
        curves.push_back(curve_points(o));
        for (const Vec2& p : curves.back()) {
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
            result.radius = std::max(result.radius, glm::length(p));
        }
    }
    if (!(lo.x <= hi.x && lo.y <= hi.y)) return result;
    const Vec2 first = glm::floor(lo / cell) - 1.0, last = glm::floor(hi / cell) + 2.0;
    const Vec2 size = last - first;
    if (!(size.x <= kMaxCells && size.y <= kMaxCells))
        throw Error("a footprint " + std::to_string(1e3 * std::max(hi.x - lo.x, hi.y - lo.y)) +
                    " mm wide does not fit into " + std::to_string(kMaxCells) +
                    " texels: use a larger texel size or a smaller brush");
    result.lo = first * cell;
    result.width = static_cast<int>(size.x);
    result.height = static_cast<int>(size.y);
    result.radius += 2 * cell;
    Coverage coverage(result.width, result.height);
    for (const auto& curve : curves) {
        for (std::size_t k = 0; k < curve.size(); ++k)
            coverage.add(curve[k] / cell - first, curve[(k + 1) % curve.size()] / cell - first);
    }
    result.coverage.resize(static_cast<std::size_t>(result.width) * result.height);
    for (int j = 0; j < result.height; j += Coverage::kRows)
        coverage.resolve(j, result.coverage.data() + static_cast<std::size_t>(j) * result.width);
    return result;
}

}  // namespace tuft::footprint
