#include "decal/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "atlas/seams/half_edges.h"

namespace tuft::decal {
namespace {

constexpr double kLeastCell = 1e-4;  // metres
constexpr double kMostCells = 4e6;
constexpr double kLeastPaint = 5e-8;  // m²: less is a speck that no one would apply
constexpr double kSlit = 2e-6;        // metres: sides of a slit nearer than this are one
constexpr double kPainted = 0.5;      // coverage
constexpr double kWidestClosing = 3;  // of `join`: with hardly a bleed nothing bridges gaps
constexpr double kLeastHole = 3;      // of the bleed, or half of `join`: smaller holes are a nuisance to cut and lay

/// Nodes of a grid over the panel's plane.
struct Grid {
    Vec2 origin{0};
    double cell = 1e-4;
    int width = 0, height = 0;

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    Vec2 node(double x, double y) const { return origin + cell * Vec2(x, y); }
};

Grid grid_over(const PrintSurface& surface, double margin, double texel) {
    Box2 box{surface.flat[0], surface.flat[0]};
    for (const auto& face : surface.faces)
        for (const std::uint32_t v : face)
            box.lo = glm::min(box.lo, surface.flat[v]), box.hi = glm::max(box.hi, surface.flat[v]);
    const Vec2 size = box.size() + Vec2(2 * margin);
    Grid grid;
    grid.cell = std::max({kLeastCell, texel, std::sqrt(size.x * size.y / kMostCells)});
    grid.width = static_cast<int>(std::ceil(size.x / grid.cell)) + 3;
    grid.height = static_cast<int>(std::ceil(size.y / grid.cell)) + 3;
    grid.origin = box.lo - Vec2(margin + grid.cell);
    return grid;
}

/// Coverage at the nodes. Paint beyond the seams counts for the cut line, not for the area.
struct Paint {
    std::vector<float> mean;          // coverage of the node's cell, of the panel's own triangles
    std::vector<std::uint8_t> inked;  // somewhere in it
};

Paint find_paint(const PrintSurface& surface, const CoverageFn& coverage, const Grid& grid, double texel) {
    Paint paint{std::vector<float>(grid.size(), 0), std::vector<std::uint8_t>(grid.size(), 0)};
    const int fine = std::clamp(static_cast<int>(std::ceil(grid.cell / texel)), 1, 5);
    for (std::size_t t = 0; t < surface.faces.size(); ++t) {
        const auto& f = surface.faces[t];
        const Vec2 a = (surface.flat[f[0]] - grid.origin) / grid.cell;
        const Vec2 x = (surface.flat[f[1]] - grid.origin) / grid.cell - a;
        const Vec2 y = (surface.flat[f[2]] - grid.origin) / grid.cell - a;
        const double det = x.x * y.y - x.y * y.x;
        if (!(det > 0)) continue;
        const Vec2 lo = glm::min(a, glm::min(a + x, a + y)), hi = glm::max(a, glm::max(a + x, a + y));
        const double step = 1.0 / fine, first = 0.5 * step - 0.5;  // of the samples of a cell about its node
        for (int j = static_cast<int>(std::floor(lo.y)); j <= static_cast<int>(std::ceil(hi.y)); ++j)
            for (int i = static_cast<int>(std::floor(lo.x)); i <= static_cast<int>(std::ceil(hi.x)); ++i)
                for (int k = 0; k < fine * fine; ++k) {
                    const Vec2 d = Vec2(i + first + step * (k % fine), j + first + step * (k / fine)) - a;
                    const double b = (d.x * y.y - d.y * y.x) / det, c = (x.x * d.y - x.y * d.x) / det;
                    if (b < 0 || c < 0 || b + c >= 1) continue;
                    Weights w{};
                    for (std::size_t m = 0; m < 3; ++m)
                        w[m] = (1 - b - c) * surface.weights[t][0][m] + b * surface.weights[t][1][m] +
                               c * surface.weights[t][2][m];
                    const double value = coverage(surface.source[t], w);
                    const std::size_t at = grid.index(i, j);
                    if (t < surface.n_own) paint.mean[at] += static_cast<float>(value / (fine * fine));
                    if (value > kPainted) paint.inked[at] = 1;
                }
    }
    return paint;
}

/// Lower envelope of the parabolas (q − p)² + f(p) along a line of nodes.
void transform_line(std::vector<double>& f, std::vector<double>& out, std::vector<int>& v, std::vector<double>& z) {
    const int n = static_cast<int>(f.size());
    int k = -1;
    for (int q = 0; q < n; ++q) {
        if (std::isinf(f[static_cast<std::size_t>(q)])) continue;
        double s = -std::numeric_limits<double>::infinity();
        while (k >= 0) {
            const int p = v[static_cast<std::size_t>(k)];
            s = ((f[static_cast<std::size_t>(q)] + double{1} * q * q) -
                 (f[static_cast<std::size_t>(p)] + double{1} * p * p)) /
                (2.0 * (q - p));
            if (s > z[static_cast<std::size_t>(k)]) break;
            --k;
        }
        ++k;
        v[static_cast<std::size_t>(k)] = q;
        z[static_cast<std::size_t>(k)] = k == 0 ? -std::numeric_limits<double>::infinity() : s;
    }
    if (k < 0) {
        std::fill(out.begin(), out.end(), std::numeric_limits<double>::infinity());
        return;
    }
    int j = 0;
    for (int q = 0; q < n; ++q) {
        while (j < k && z[static_cast<std::size_t>(j) + 1] < q) ++j;
        const int p = v[static_cast<std::size_t>(j)];
        out[static_cast<std::size_t>(q)] = double{1} * (q - p) * (q - p) + f[static_cast<std::size_t>(p)];
    }
}

/// Distance of each node to the nearest node where `set` holds, less half a cell, metres.
template <class Set>
std::vector<float> distance_to(const Grid& grid, Set&& set) {
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<double> square(grid.size());
    for (std::size_t i = 0; i < square.size(); ++i) square[i] = set(i) ? 0 : infinite;
    const auto longest = static_cast<std::size_t>(std::max(grid.width, grid.height));
    std::vector<double> f, out, z(longest + 1);
    std::vector<int> v(longest + 1);
    for (int x = 0; x < grid.width; ++x) {
        f.resize(static_cast<std::size_t>(grid.height));
        out.resize(f.size());
        for (int y = 0; y < grid.height; ++y) f[static_cast<std::size_t>(y)] = square[grid.index(x, y)];
        transform_line(f, out, v, z);
        for (int y = 0; y < grid.height; ++y) square[grid.index(x, y)] = out[static_cast<std::size_t>(y)];
    }
    std::vector<float> distance(grid.size());
    for (int y = 0; y < grid.height; ++y) {
        f.resize(static_cast<std::size_t>(grid.width));
        out.resize(f.size());
        for (int x = 0; x < grid.width; ++x) f[static_cast<std::size_t>(x)] = square[grid.index(x, y)];
        transform_line(f, out, v, z);
        for (int x = 0; x < grid.width; ++x)
            distance[grid.index(x, y)] =
                static_cast<float>(grid.cell * (std::sqrt(out[static_cast<std::size_t>(x)]) - 0.5));
    }
    return distance;
}

/// Rings of the line where `field` is 0, with what is positive on their left (marching squares).
Region zero_lines(const Grid& grid, const std::vector<float>& field) {
    const auto value = [&](int x, int y) {
        const bool rim = x <= 0 || y <= 0 || x >= grid.width - 1 || y >= grid.height - 1;
        return rim ? std::min(field[grid.index(x, y)], -1e-9f) : field[grid.index(x, y)];
    };
    // Edge 2 i of node i goes to the right, 2 i + 1 upwards.
    std::unordered_map<std::size_t, std::size_t> next;
    for (int y = 0; y + 1 < grid.height; ++y)
        for (int x = 0; x + 1 < grid.width; ++x) {
            const std::size_t edge[4] = {2 * grid.index(x, y), 2 * grid.index(x + 1, y) + 1, 2 * grid.index(x, y + 1),
                                         2 * grid.index(x, y) + 1};
            const bool in[4] = {value(x, y) > 0, value(x + 1, y) > 0, value(x + 1, y + 1) > 0, value(x, y + 1) > 0};
            // Counter-clockwise round the cell, side k goes from corner k to k + 1. The line comes in where it leaves
            // the inside and goes to the next side where the cell's rim enters it again, so corners are cut off alone.
            for (int k = 0; k < 4; ++k) {
                if (!(in[k] && !in[(k + 1) % 4])) continue;
                int m = k;  // back to where this run of inside corners began
                while (in[m]) m = (m + 3) % 4;
                next[edge[k]] = edge[m];
            }
        }
    const auto point = [&](std::size_t edge) {
        const std::size_t i = edge / 2;
        const int x = static_cast<int>(i % static_cast<std::size_t>(grid.width));
        const int y = static_cast<int>(i / static_cast<std::size_t>(grid.width));
        const double a = value(x, y), b = edge % 2 ? value(x, y + 1) : value(x + 1, y);
        const double s = a / (a - b);
        return edge % 2 ? grid.node(x, y + s) : grid.node(x + s, y);
    };
    std::vector<std::size_t> starts;
    starts.reserve(next.size());
    for (const auto& [from, to] : next) starts.push_back(from);
    std::sort(starts.begin(), starts.end());
    Region region;
    for (const std::size_t start : starts) {
        Ring ring;
        std::size_t edge = start;
        for (auto it = next.find(edge); it != next.end(); it = next.find(edge)) {
            ring.push_back(point(edge));
            edge = it->second;
            next.erase(it);
        }
        if (ring.size() > 2) region.push_back(std::move(ring));
    }
    return region;
}

/// Half-edges of the chart's border in order.
std::vector<std::uint32_t> border_of(const atlas::ChartMesh& chart) {
    std::uint32_t start = 0;
    while (chart.twin[start] != kNone) ++start;
    std::vector<std::uint32_t> border;
    std::uint32_t h = start;
    do {
        border.push_back(h);
        h = mesh::next_half(h);
        while (chart.twin[h] != kNone) h = mesh::next_half(chart.twin[h]);
    } while (h != start && border.size() <= chart.twin.size());
    return border;
}

/// A run of a panel's border beside one neighbour, or none.
struct BorderRun {
    std::vector<Vec2> line;  // the panel lies on its left
    double reach = 0;        // metres of film beyond it
    bool seam = false;       // beside another panel

    /// Whether it runs from one end to the other, and not into the panel and back.
    bool is_straight() const {
        double length = 0;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) length += glm::length(line[i + 1] - line[i]);
        return glm::length(line.back() - line.front()) > 0.5 * length;
    }

    /// The line with straight ends `more` metres longer.
    std::vector<Vec2> extended(double more) const {
        std::vector<Vec2> out = line;
        const Vec2 first = line[0] - line[1], last = line.back() - line[line.size() - 2];
        out.insert(out.begin(), line.front() + more / glm::length(first) * first);
        out.push_back(line.back() + more / glm::length(last) * last);
        return out;
    }

    /// What lies more than `reach` and less than that and `depth` beyond a seam: its line moved outwards.
    Region beyond(double depth) const {
        Vec2 along = line.back() - line.front();
        along /= glm::length(along);
        const Vec2 out{along.y, -along.x};
        const std::vector<Vec2> edge = extended(depth);
        Ring ring;
        for (const Vec2& p : edge) ring.push_back(p + reach * out);
        for (auto p = edge.rbegin(); p != edge.rend(); ++p) ring.push_back(*p + (reach + depth) * out);
        if (area_of(ring) < 0) std::reverse(ring.begin(), ring.end());
        return unite({ring}, {});
    }
};

std::vector<BorderRun> border_runs(const FilmMesh& film, const Panel& panel, const OutlineOptions& options,
                                   double free) {
    const std::vector<std::uint32_t> border = border_of(panel.chart);
    const std::vector<std::uint32_t> twin = atlas::twin_half_edges(film.mesh);
    const std::uint32_t own = film.label[panel.chart.triangles[0]];
    const auto label_beyond = [&](std::uint32_t h) {
        const std::uint32_t other = twin[3 * panel.chart.triangles[h / 3] + h % 3];
        return other == kNone ? kNone : film.label[other / 3];
    };
    const std::size_t n = border.size();
    std::size_t first = 0;
    while (first < n && label_beyond(border[first]) == label_beyond(border[(first + n - 1) % n])) ++first;
    first %= n;
    std::vector<BorderRun> runs;
    for (std::size_t i = 0; i < n;) {
        const std::uint32_t label = label_beyond(border[(first + i) % n]);
        BorderRun run{.line = {},
                      .reach = label == kNone ? free
                               : label == own ? 0
                                              : options.overlap(label),
                      .seam = label != kNone && label != own};
        const auto corner = [&](std::size_t k, std::uint32_t next) {
            const std::uint32_t h = border[(first + k) % n];
            return panel.flat[panel.chart.faces[h / 3][(h % 3 + next) % 3]];
        };
        run.line.push_back(corner(i, 0));
        for (; i < n && label_beyond(border[(first + i) % n]) == label; ++i) run.line.push_back(corner(i, 1));
        runs.push_back(std::move(run));
    }
    return runs;
}

/// Where film may lie: the panel, `free` beyond its open borders, as far as `overlap` beyond its seams.
Region allowed_region(const FilmMesh& film, const Panel& panel, const OutlineOptions& options, double free) {
    Ring ring;
    for (const std::uint32_t v : panel.chart.loop) ring.push_back(panel.flat[v]);
    const Region own = offset(offset({ring}, kSlit), -kSlit);
    const std::vector<BorderRun> runs = border_runs(film, panel, options, free);
    if (runs.size() == 1) return runs[0].reach > 0 ? offset(own, runs[0].reach) : own;
    Region around, beyond;
    for (const BorderRun& run : runs) {
        const bool open = run.is_straight();
        if (run.reach > 0) around = unite(around, sweep(run.seam && open ? run.extended(free) : run.line, run.reach));
        if (run.seam && open) beyond = unite(beyond, run.beyond(2 * free));
    }
    return unite(own, subtract(around, beyond));
}

/// The closing of the paint by `around`, `bleed` beyond it.
Region film_round(const Grid& grid, const std::vector<std::uint8_t>& inked, double bleed, double around) {
    std::vector<float> field = distance_to(grid, [&](std::size_t i) { return inked[i] != 0; });
    if (around <= bleed + grid.cell) {
        for (float& d : field) d = static_cast<float>(bleed) - d;
        return zero_lines(grid, field);
    }
    std::vector<std::uint8_t> outside(grid.size());
    for (std::size_t i = 0; i < outside.size(); ++i) outside[i] = field[i] > around;
    field = distance_to(grid, [&](std::size_t i) { return outside[i] != 0; });
    for (float& d : field) d -= static_cast<float>(around - bleed);
    return zero_lines(grid, field);
}

/// Leaves out holes smaller than a disc of radius `radius`.
Region without_small_holes(const Region& region, double radius) {
    Region out;
    for (const Ring& ring : region)
        if (area_of(ring) > 0 || -area_of(ring) > 3.14 * radius * radius) out.push_back(ring);
    return out;
}

double paint_inside(const Grid& grid, const std::vector<float>& coverage, const Region& film) {
    const Box2 box = box_of(film);
    const Vec2 lo = (box.lo - grid.origin) / grid.cell, hi = (box.hi - grid.origin) / grid.cell;
    double sum = 0;
    for (int y = std::max(0, static_cast<int>(lo.y)); y <= std::min(grid.height - 1, static_cast<int>(hi.y) + 1); ++y)
        for (int x = std::max(0, static_cast<int>(lo.x)); x <= std::min(grid.width - 1, static_cast<int>(hi.x) + 1);
             ++x)
            if (const float c = coverage[grid.index(x, y)]; c > 0 && contains(film, grid.node(x, y))) sum += c;
    return sum * grid.cell * grid.cell;
}

/// The least distance at which the closing bridges two points `join` apart: √(g² − ¼ join²) = g − bleed.
double closing_distance(const OutlineOptions& options) {
    const double half = 0.5 * options.join;
    if (half <= options.bleed) return options.bleed;
    const double bridging = (half * half + options.bleed * options.bleed) / (2 * std::max(options.bleed, 1e-9));
    return std::min(bridging, kWidestClosing * options.join);
}

}  // namespace

std::vector<Outline> find_outlines(const FilmMesh& film, const Panel& panel, const PrintSurface& surface,
                                   const CoverageFn& coverage, const OutlineOptions& options) {
    const double around = closing_distance(options);
    const Grid grid = grid_over(surface, around + 2 * kLeastCell, options.texel);
    const Paint paint = find_paint(surface, coverage, grid, options.texel);
    if (std::find(paint.inked.begin(), paint.inked.end(), 1) == paint.inked.end()) return {};
    const Region allowed = allowed_region(film, panel, options, options.bleed + options.least_side);
    const double tolerance = std::min(2e-5, 0.25 * grid.cell);
    const Region wanted = simplify(without_small_holes(film_round(grid, paint.inked, options.bleed, around),
                                                       kLeastHole * std::max(options.bleed, 0.5 * options.join)),
                                   tolerance);
    std::vector<Outline> outlines;
    for (Region& part : separate(intersect(wanted, allowed))) {
        const Vec2 size = box_of(part).size();
        const double side = std::min(size.x, size.y);
        if (side < options.least_side) part = intersect(offset(part, 0.5 * (options.least_side - side)), allowed);
        const double area = paint_inside(grid, paint.mean, part);
        if (area > kLeastPaint) outlines.push_back({simplify(part, 0.5 * tolerance), area});
    }
    return outlines;
}

}  // namespace tuft::decal
