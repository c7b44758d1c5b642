#include "footprint/outline/bands.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/simd.h"
#include "footprint/outline/picture.h"

namespace tuft::footprint {
namespace {

/// A band from x0 to x1, about the line from y0 on with `slope`, of half width `stretch` (r + grow
/// x).
struct Band {
    double x0 = 0, x1 = 0, y0 = 0, slope = 0, r = 0, grow = 0, stretch = 1;
};

/// Part of a column of cells that a band covers: from `lo` to `hi`, `whole` of 255 of its width.
struct ColumnCoverage {
    float lo, hi, whole;
};

/// Of column i, from x = i to i + 1. Plain, for any instruction set. Where it covers nothing, `hi`
/// is not above `lo`.
[[gnu::always_inline]] inline ColumnCoverage coverage_of_column(const Band& band, int i, float cells) {
    const double before = i, after = before + 1;
    const double from = band.x0 > before ? band.x0 : before, to = band.x1 < after ? band.x1 : after;
    const double x = 0.5 * (from + to) - band.x0, y = band.y0 + band.slope * x;
    const double half = (band.r + band.grow * x) * band.stretch;
    const auto lo = static_cast<float>(y - half), hi = static_cast<float>(y + half);
    const float low = lo > 0 ? lo : 0.0f, high = hi < cells ? hi : cells;
    const bool some = (to > from) & (high > low);
    return {some ? low : cells, some ? high : -1.0f, static_cast<float>(255 * (to - from))};
}

constexpr int kFew = 8, kAtOnce = 16;  // columns; a picture has as many cells more beyond its last one

/// Values of `n` columns, one vector: left to itself, the compiler works on cells and their floats in quarters of it.
template <int n>
struct Lanes {
    using Float [[gnu::vector_size(4 * n)]] = float;
    using Int [[gnu::vector_size(4 * n)]] = std::int32_t;
    using Byte [[gnu::vector_size(n)]] = std::uint8_t;
};

/// Adds a band to `n` columns from i on.
template <int n>
[[gnu::always_inline]] inline void draw_columns(std::uint8_t* __restrict level, int rows, int columns, const Band& band,
                                                int i) {
    using Float = typename Lanes<n>::Float;
    const auto cells = static_cast<float>(rows);
    alignas(64) float lo[n], hi[n], whole[n];
    float lowest = cells, highest = -1;
#pragma omp simd reduction(min : lowest) reduction(max : highest)
    for (int t = 0; t < n; ++t) {
        const ColumnCoverage c = coverage_of_column(band, i + t, cells);
        lo[t] = c.lo;
        hi[t] = c.hi;
        whole[t] = c.whole;
        lowest = c.lo < lowest ? c.lo : lowest;
        highest = c.hi > highest ? c.hi : highest;
    }
    Float from, to, width;
    std::memcpy(&from, lo, sizeof from);
    std::memcpy(&to, hi, sizeof to);
    std::memcpy(&width, whole, sizeof width);
    for (int j = static_cast<int>(lowest); static_cast<float>(j) < highest; ++j) {
        std::uint8_t* cell = level + std::size_t(j) * columns + i;
        typename Lanes<n>::Byte was;
        std::memcpy(&was, cell, sizeof was);
        const Float low = Float{} + static_cast<float>(j), high = low + 1.0f;
        const Float part = (to < high ? to : high) - (from > low ? from : low);
        const Float v = __builtin_convertvector(was, Float) + width * (part > 0.0f ? part : Float{}) + 0.5f;
        const auto level_of = __builtin_convertvector(v < 255.0f ? v : Float{} + 255.0f, typename Lanes<n>::Int);
        was = __builtin_convertvector(level_of, typename Lanes<n>::Byte);
        std::memcpy(cell, &was, sizeof was);
    }
}

/// Adds a band to columns `first` to `last` of a picture by rows, [rows columns]. Cells that it
/// does not cover stay. Most pieces of hair are a few columns long.
TUFT_CLONES void draw_along(std::uint8_t* __restrict level, int rows, int columns, const Band& band, int first,
                            int last) {
    int i = first;
    for (; i + kFew <= last; i += kAtOnce) draw_columns<kAtOnce>(level, rows, columns, band, i);
    if (i <= last) draw_columns<kFew>(level, rows, columns, band, i);
}

/// The same in a picture by columns, [columns rows].
void draw_across(std::uint8_t* level, int rows, const Band& band, int first, int last) {
    for (int i = first; i <= last; ++i) {
        const ColumnCoverage c = coverage_of_column(band, i, static_cast<float>(rows));
        for (int j = static_cast<int>(c.lo); static_cast<float>(j) < c.hi; ++j) {
            std::uint8_t& cell = level[std::size_t(i) * rows + j];
            const auto low = static_cast<float>(j);
            const float part = std::min(c.hi, low + 1) - std::max(c.lo, low);
            cell = static_cast<std::uint8_t>(std::min(255.0f, static_cast<float>(cell) + c.whole * part + 0.5f));
        }
    }
}

}  // namespace

Bands::Bands(int width, int height, bool steep)
    : width_(width), height_(height), steep_(steep), level_(std::size_t(width) * height + kAtOnce, 0) {}

void Bands::draw(Vec2 p, Vec2 q, double r, double s, const Vec2& across) {
    const bool steep = std::abs(across.x) > std::abs(across.y);
    if (steep) {
        std::swap(p.x, p.y);
        std::swap(q.x, q.y);
    }
    if (p.x > q.x) {
        std::swap(p, q);
        std::swap(r, s);
    }
    const double run = q.x - p.x;
    if (!(run > 1e-9)) return;
    const double slope = (q.y - p.y) / run, grow = (s - r) / run;
    // A band is cut along its columns; what it measures there.
    const double along = steep ? across.y : across.x, over = steep ? across.x : across.y;
    const double stretch = std::min(std::abs(over - slope * along), 1.0);
    const int columns = steep ? height_ : width_, rows = steep ? width_ : height_;
    const int first = std::max(static_cast<int>(p.x), 0), last = std::min(static_cast<int>(q.x), columns - 1);
    const Band band{p.x, std::min(q.x, double(columns)), p.y, slope, r, grow, stretch};
    if (steep == steep_)
        draw_along(level_.data(), rows, columns, band, first, last);
    else
        draw_across(level_.data(), rows, band, first, last);
}

void Bands::copy_rows(Recycled<std::uint8_t>& level) const {
    const auto cells = std::span(level_).first(std::size_t(width_) * height_);
    if (steep_)
        transpose(cells, height_, width_, level);
    else
        level.assign(cells.begin(), cells.end());
}

}  // namespace tuft::footprint
