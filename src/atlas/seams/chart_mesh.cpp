#include "atlas/seams/chart_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/segment.h"

namespace tuft::atlas {
namespace {

/// Walks the borders; true when there is exactly one, which is then in `loop`.
bool walk_border(const ChartMesh& chart, std::vector<std::uint32_t>& loop) {
    const auto n_half = static_cast<std::uint32_t>(3 * chart.faces.size());
    std::size_t n_border = 0;
    std::uint32_t start = kNone;
    for (std::uint32_t h = 0; h < n_half; ++h) {
        if (chart.twin[h] != kNone) continue;
        ++n_border;
        if (start == kNone) start = h;
    }
    if (start == kNone) return false;
    std::uint32_t h = start;
    do {
        loop.push_back(chart.faces[h / 3][h % 3]);
        h = next_half(h);
        while (chart.twin[h] != kNone) h = next_half(chart.twin[h]);
    } while (h != start && loop.size() <= n_border);
    return loop.size() == n_border;
}

}  // namespace

ChartMesh make_chart(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> glued,
                     std::vector<std::uint32_t> triangles, double unit, std::span<std::uint32_t> place) {
    ChartMesh chart;
    chart.triangles = std::move(triangles);
    const auto n = static_cast<std::uint32_t>(chart.triangles.size());
    chart.twin.resize(3 * std::size_t{n});
    for (std::uint32_t t = 0; t < n && !place.empty(); ++t) place[chart.triangles[t]] = t;
    for (std::uint32_t h = 0; h < 3 * n; ++h) {
        const std::uint32_t g = glued[3 * chart.triangles[h / 3] + h % 3];
        if (place.empty() || g == kNone)
            chart.twin[h] = local_half(chart.triangles, g);
        else
            chart.twin[h] = 3 * place[g / 3] + g % 3;
    }

    const Vec3 origin = mesh.position(chart.triangles[0], 0);
    chart.faces.assign(n, {kNone, kNone, kNone});
    std::size_t n_border = 0;
    for (std::uint32_t c = 0; c < 3 * n; ++c) {
        n_border += chart.twin[c] == kNone;
        if (chart.faces[c / 3][c % 3] != kNone) continue;
        const auto v = static_cast<std::uint32_t>(chart.position.size());
        chart.position.push_back((mesh.position(chart.triangles[c / 3], static_cast<int>(c % 3)) - origin) / unit);
        for (std::uint32_t h = c; h != kNone && chart.faces[h / 3][h % 3] == kNone; h = chart.twin[prev_half(h)])
            chart.faces[h / 3][h % 3] = v;
        for (std::uint32_t g = chart.twin[c]; g != kNone;) {
            const std::uint32_t h = next_half(g);
            if (chart.faces[h / 3][h % 3] != kNone) break;
            chart.faces[h / 3][h % 3] = v;
            g = chart.twin[h];
        }
    }
    for (const auto& f : chart.faces)
        chart.area += 0.5 * glm::length(glm::cross(chart.position[f[1]] - chart.position[f[0]],
                                                   chart.position[f[2]] - chart.position[f[0]]));
    const auto n_edges = static_cast<std::int64_t>((3 * std::size_t{n} + n_border) / 2);
    const auto euler = static_cast<std::int64_t>(chart.n_vertices()) - n_edges + n;
    chart.disk = walk_border(chart, chart.loop) && euler == 1;
    return chart;
}

std::vector<std::vector<std::uint32_t>> connected_charts(std::span<const std::uint32_t> glued) {
    const auto n = static_cast<std::uint32_t>(glued.size() / 3);
    std::vector<std::uint32_t> label(n, kNone), stack;
    std::vector<std::vector<std::uint32_t>> charts;
    for (std::uint32_t t = 0; t < n; ++t) {
        if (label[t] == kNone) {
            const auto chart = static_cast<std::uint32_t>(charts.size());
            charts.emplace_back();
            label[t] = chart;
            stack.assign(1, t);
            while (!stack.empty()) {
                const std::uint32_t s = stack.back();
                stack.pop_back();
                for (std::uint32_t h = 3 * s; h < 3 * s + 3; ++h) {
                    if (glued[h] == kNone || label[glued[h] / 3] != kNone) continue;
                    label[glued[h] / 3] = chart;
                    stack.push_back(glued[h] / 3);
                }
            }
        }
        charts[label[t]].push_back(t);
    }
    return charts;
}

FlatCheck check_flat(const ChartMesh& chart, std::span<const Vec2> uv, double gap) {
    FlatCheck check;
    for (const Vec2& p : uv)
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
            check.finite = false;
            return check;
        }
    std::vector<std::pair<float, float>> stretch;  // largest singular value, area
    stretch.reserve(chart.faces.size());
    double sum = 0, area = 0;
    for (const auto& f : chart.faces) {
        const Vec3 e1 = chart.position[f[1]] - chart.position[f[0]];
        const Vec3 e2 = chart.position[f[2]] - chart.position[f[0]];
        const Vec2 d1 = uv[f[1]] - uv[f[0]], d2 = uv[f[2]] - uv[f[0]];
        const double det = d1.x * d2.y - d1.y * d2.x;
        check.uv_area += 0.5 * det;
        if (!(det > 0)) {
            ++check.flips;
            continue;
        }
        const double a3 = 0.5 * glm::length(glm::cross(e1, e2));
        // Metric of the map UV -> surface: singular values squared are its eigenvalues.
        const Vec3 su = (e1 * d2.y - e2 * d1.y) / det, sv = (e2 * d1.x - e1 * d2.x) / det;
        const double a = glm::dot(su, su), b = glm::dot(su, sv), c = glm::dot(sv, sv);
        const double largest = 0.5 * (a + c + std::sqrt((a - c) * (a - c) + 4 * b * b));
        sum += a3 * 0.5 * (a + c);
        area += a3;
        check.linf = std::max(check.linf, std::sqrt(largest));
        stretch.emplace_back(static_cast<float>(std::sqrt(largest)), static_cast<float>(a3));
    }
    check.l2 = area > 0 ? std::sqrt(sum / area) : 1;
    // The largest first, for as long as they are needed.
    std::make_heap(stretch.begin(), stretch.end());
    double above = 0;
    for (auto end = stretch.end(); end != stretch.begin() && above <= 1e-3 * area; --end) {
        std::pop_heap(stretch.begin(), end);
        check.stretch_999 = (end - 1)->first;
        above += (end - 1)->second;
    }
    if (check.flips == 0 && chart.disk) check.crosses = crosses_itself(chart, uv, gap);
    return check;
}

namespace {

/// Edges of a closed polygon by the square cells within `reach` of them.
struct EdgeGrid {
    std::vector<std::uint32_t> start, items;

    EdgeGrid(const std::vector<Vec2>& p, const Vec2& lo, const Vec2& hi, double cell, double reach) {
        const std::size_t n = p.size();
        const auto columns = static_cast<std::size_t>((hi.x - lo.x) / cell) + 1;
        const auto rows = static_cast<std::size_t>((hi.y - lo.y) / cell) + 1;
        const auto index = [&](double x, std::size_t count) {
            return std::min(static_cast<std::size_t>(std::max(0.0, x / cell)), count - 1);
        };
        const auto for_cells = [&](std::size_t i, auto&& visit) {
            const Vec2 a = p[i] - lo, b = p[(i + 1) % n] - lo;
            const std::size_t y0 = index(std::min(a.y, b.y) - reach, rows);
            const std::size_t y1 = index(std::max(a.y, b.y) + reach, rows);
            for (std::size_t y = y0; y <= y1; ++y) {
                double xa = std::min(a.x, b.x), xb = std::max(a.x, b.x);
                if (std::abs(b.y - a.y) > cell) {  // the part of the edge that nears this row
                    const double slope = (b.x - a.x) / (b.y - a.y);
                    const double y_lo = static_cast<double>(y) * cell - reach;
                    const double x0 = a.x + slope * (y_lo - a.y);
                    const double x1 = x0 + slope * (cell + 2 * reach);
                    xa = std::max(xa, std::min(x0, x1) - 1e-6 * cell);
                    xb = std::min(xb, std::max(x0, x1) + 1e-6 * cell);
                }
                const std::size_t x1 = index(xb + reach, columns);
                for (std::size_t x = index(xa - reach, columns); x <= x1; ++x) visit(y * columns + x);
            }
        };
        start.assign(columns * rows + 1, 0);
        for (std::size_t i = 0; i < n; ++i) for_cells(i, [&](std::size_t c) { ++start[c + 1]; });
        for (std::size_t c = 0; c + 1 < start.size(); ++c) start[c + 1] += start[c];
        std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
        items.resize(start.back());
        for (std::size_t i = 0; i < n; ++i)
            for_cells(i, [&](std::size_t c) { items[fill[c]++] = static_cast<std::uint32_t>(i); });
    }
};

}  // namespace

bool crosses_itself(const ChartMesh& chart, std::span<const Vec2> uv, double gap, double near) {
    const std::vector<std::uint32_t>& loop = chart.loop;
    const std::size_t n = loop.size();
    if (n < 4) return false;
    Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    std::vector<Vec2> p(n);
    std::vector<double> along(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        p[i] = uv[loop[i]];
        lo = glm::min(lo, p[i]);
        hi = glm::max(hi, p[i]);
        along[i + 1] = along[i] + glm::length(uv[loop[(i + 1) % n]] - p[i]);
    }
    // Slits of flat surfaces touch up to rounding: a crossing must be deeper than this.
    const double size = glm::length(hi - lo);
    const double touch = 1e-9 * size;
    const double cell = std::max({along[n] / static_cast<double>(n), size / 2048, 2 * gap, 1e-300});
    const EdgeGrid grid(p, lo, hi, cell, 0.5 * gap);

    const auto height = [](const Vec2& o, const Vec2& d, const Vec2& q) {
        return d.x * (q.y - o.y) - d.y * (q.x - o.x);
    };
    const auto meet = [&](std::size_t i, std::size_t j) {
        const double between = std::abs(along[i] - along[j]);
        const double apart = std::min(between, along[n] - between);
        if (apart < near * along[n]) return false;
        const Vec2 a = p[i], b = p[(i + 1) % n], c = p[j], d = p[(j + 1) % n];
        const double lab = touch * glm::length(b - a), lcd = touch * glm::length(d - c);
        const double c1 = height(a, b - a, c), c2 = height(a, b - a, d);
        const double a1 = height(c, d - c, a), a2 = height(c, d - c, b);
        if (((c1 > lab && c2 < -lab) || (c1 < -lab && c2 > lab)) &&
            ((a1 > lcd && a2 < -lcd) || (a1 < -lcd && a2 > lcd)))
            return true;
        if (!(gap > 0)) return false;
        if (apart < 16 * gap) return false;
        // The chart lies left of its border: only what is near on the right is too near.
        if (height(a, b - a, 0.5 * (c + d)) > 0 || height(c, d - c, 0.5 * (a + b)) > 0) return false;
        if (std::min(std::min(segment_distance(c, d, a), segment_distance(c, d, b)),
                     std::min(segment_distance(a, b, c), segment_distance(a, b, d))) >= gap)
            return false;
        const Vec3 middle_i = chart.position[loop[i]] + chart.position[loop[(i + 1) % n]];
        const Vec3 middle_j = chart.position[loop[j]] + chart.position[loop[(j + 1) % n]];
        const double lengths = along[i + 1] - along[i] + along[j + 1] - along[j];
        return 0.5 * glm::length(middle_i - middle_j) > 2 * gap + 0.5 * lengths;
    };
    for (std::size_t c = 0; c + 1 < grid.start.size(); ++c)
        for (std::uint32_t x = grid.start[c]; x < grid.start[c + 1]; ++x)
            for (std::uint32_t y = x + 1; y < grid.start[c + 1]; ++y)
                if (grid.items[x] != grid.items[y] && meet(grid.items[x], grid.items[y])) return true;
    return false;
}

}  // namespace tuft::atlas
