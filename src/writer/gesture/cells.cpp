#include "writer/gesture/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tuft::writer {
namespace {

/// Lower envelope of parabolas: d[q] = min over p of (q − p)² + f[p], in place.
void transform_line(std::vector<double>& f) {
    const std::size_t n = f.size();
    std::vector<std::size_t> v(n, 0);
    std::vector<double> z(n + 1), d(n);
    std::size_t k = 0;
    const double far = std::numeric_limits<double>::infinity();
    z[0] = -far, z[1] = far;
    const auto crossing = [&](std::size_t q, std::size_t p) {
        const auto a = static_cast<double>(q), b = static_cast<double>(p);
        return ((f[q] + a * a) - (f[p] + b * b)) / (2 * (a - b));
    };
    for (std::size_t q = 1; q < n; ++q) {
        double s = crossing(q, v[k]);
        while (k > 0 && s <= z[k]) s = crossing(q, v[--k]);
        v[++k] = q, z[k] = s, z[k + 1] = far;
    }
    k = 0;
    for (std::size_t q = 0; q < n; ++q) {
        while (z[k + 1] < static_cast<double>(q)) ++k;
        const double apart = static_cast<double>(q) - static_cast<double>(v[k]);
        d[q] = apart * apart + f[v[k]];
    }
    f = d;
}

}  // namespace

std::size_t Cells::count() const {
    return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
}

Cells cells_over(std::span<const Ring> rings, double cell, double margin) {
    Vec2 lo(1e300), hi(-1e300);
    for (const Ring& ring : rings)
        for (const Vec2& p : ring) lo = glm::min(lo, p), hi = glm::max(hi, p);
    Cells cells{.cell = cell};
    if (lo.x > hi.x) return cells;
    cells.lo = cell * glm::floor((lo - margin) / cell);
    const Vec2 size = glm::ceil((hi + margin - cells.lo) / cell);
    cells.width = static_cast<int>(size.x), cells.height = static_cast<int>(size.y);
    cells.inside.assign(std::size_t(cells.width) * cells.height, 0);
    return cells;
}

void fill(Cells& cells, std::span<const Ring> rings) {
    struct Crossing {
        double x;
        int winding;
    };
    std::vector<Crossing> row;
    for (int j = 0; j < cells.height; ++j) {
        const double y = cells.centre(0, j).y;
        row.clear();
        for (const Ring& ring : rings)
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
                if ((a.y <= y) == (b.y <= y)) continue;
                row.push_back({a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x), a.y <= y ? 1 : -1});
            }
        std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
        int winding = 0;
        for (std::size_t k = 0; k + 1 < row.size(); ++k) {
            winding += row[k].winding;
            if (winding == 0) continue;
            const auto cell_from = [&](double x) {
                return static_cast<int>(
                    std::clamp(std::ceil((x - cells.lo.x) / cells.cell - 0.5), 0.0, static_cast<double>(cells.width)));
            };
            for (int i = cell_from(row[k].x); i < cell_from(row[k + 1].x); ++i)
                cells.inside[std::size_t(j) * cells.width + i] = 1;
        }
    }
}

std::vector<float> clearances(const Cells& cells) {
    const int w = cells.width, h = cells.height;
    constexpr double kFar = 1e12;
    std::vector<double> squared(std::size_t(w) * h);
    for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = cells.inside[i] ? kFar : 0;
    std::vector<double> line;
    for (int j = 0; j < h; ++j) {
        line.assign(squared.begin() + std::ptrdiff_t(j) * w, squared.begin() + std::ptrdiff_t(j + 1) * w);
        transform_line(line);
        std::copy(line.begin(), line.end(), squared.begin() + std::ptrdiff_t(j) * w);
    }
    line.resize(std::size_t(h));
    for (int i = 0; i < w; ++i) {
        for (int j = 0; j < h; ++j) line[j] = squared[std::size_t(j) * w + i];
        transform_line(line);
        for (int j = 0; j < h; ++j) squared[std::size_t(j) * w + i] = line[j];
    }
    std::vector<float> out(squared.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<float>(cells.cell * std::sqrt(std::min(squared[i], kFar)));
    return out;
}

std::vector<Ring> boundaries(const Cells& c, int passes) {
    // Edges from each corner of cells, at most two, by the number of the corner: column after column.
    const auto rows = static_cast<std::size_t>(c.height) + 1;
    struct Ways {
        std::array<std::uint32_t, 2> to{};
        std::uint8_t n = 0;
    };
    std::vector<Ways> next((static_cast<std::size_t>(c.width) + 1) * rows);
    const auto corner = [&](int i, int j) { return static_cast<std::size_t>(i) * rows + static_cast<std::size_t>(j); };
    const auto add = [&](std::size_t from, std::size_t to) {
        next[from].to[next[from].n++] = static_cast<std::uint32_t>(to);
    };
    for (int j = 0; j < c.height; ++j)
        for (int i = 0; i < c.width; ++i) {
            if (!c.at(i, j)) continue;
            if (!c.at(i, j - 1)) add(corner(i, j), corner(i + 1, j));
            if (!c.at(i + 1, j)) add(corner(i + 1, j), corner(i + 1, j + 1));
            if (!c.at(i, j + 1)) add(corner(i + 1, j + 1), corner(i, j + 1));
            if (!c.at(i - 1, j)) add(corner(i, j + 1), corner(i, j));
        }
    std::vector<Ring> rings;
    for (std::size_t begin = 0; begin < next.size();) {
        if (next[begin].n == 0) {
            ++begin;
            continue;
        }
        Ring ring;
        for (std::size_t at = begin; next[at].n > 0; at = next[at].to[--next[at].n])
            ring.push_back(c.lo + c.cell * Vec2(static_cast<double>(at / rows), static_cast<double>(at % rows)));
        for (int pass = 0; pass < passes; ++pass) {
            const Ring old = ring;
            const std::size_t n = ring.size();
            for (std::size_t i = 0; i < n; ++i)
                ring[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
        }
        rings.push_back(std::move(ring));
    }
    return rings;
}

}  // namespace tuft::writer
