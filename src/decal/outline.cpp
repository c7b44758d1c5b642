#include "decal/outline.h"

#include <algorithm>
#include <cmath>

#include "atlas/seams/half_edges.h"
#include "decal/paint_field.h"

namespace tuft::decal {
namespace {

constexpr double kLeastCell = 1e-4;  // metres
constexpr double kMostCells = 4e6;
constexpr double kLeastPaint = 5e-8;  // m²: less is a speck that no one would apply
constexpr double kSlit = 2e-6;        // metres: sides of a slit nearer than this are one
constexpr double kStraight = 5e-6;    // metres: points nearer than this to the line without them are left out
constexpr double kWidestClosing = 3;  // of `join`: with hardly a bleed nothing bridges gaps
// Of the bleed, within bounds in metres: radius of the inner corners of a cut line. Film tears from sharper ones, and
// the points between two arcs that meet fold over.
constexpr double kInnerCorner = 0.5, kLeastCorner = 1e-3, kMostCorner = 5e-3;
constexpr double kEndOfLine = 3e-3;  // metres, that tell how a seam goes on
constexpr double kApart = 5e-4;      // metres between two pieces that a rounded corner keeps free, as far as it can
constexpr double kLeastFilm = 1e-3, kFlatBleed = 3e-3;  // metres round the paint, that panels hold of a bleed
constexpr double kLeastHole = 3;  // of the bleed, or half of `join`: smaller holes are a nuisance to cut and lay

/// Cells between the rim of the grid and the first row. A regular mesh then has no edge along a row, whose samples
/// would lie in both triangles or in none.
const Vec2 kOffGrid{1.382, 1.236};

/// The least distance at which the closing bridges two points `join` apart: √(g² − ¼ join²) = g − bleed.
double closing_distance(double bleed, double join) {
    const double half = 0.5 * join;
    if (half <= bleed) return bleed;
    const double bridging = (half * half + bleed * bleed) / (2 * std::max(bleed, 1e-9));
    return std::min(bridging, kWidestClosing * join);
}

/// Smaller holes are film.
double hole_radius(double bleed, double join) {
    return kLeastHole * std::max(bleed, 0.5 * join);
}

Grid grid_over(const PrintSurface& surface, double margin, double texel) {
    Box2 box{surface.flat[0], surface.flat[0]};
    for (const auto& face : surface.faces)
        for (const std::uint32_t v : face)
            box.lo = glm::min(box.lo, surface.flat[v]), box.hi = glm::max(box.hi, surface.flat[v]);
    const Vec2 size = box.size() + Vec2(2 * margin);
    Grid grid;
    grid.cell = std::max({kLeastCell, texel, std::sqrt(size.x * size.y / kMostCells)});
    grid.width = static_cast<int>(std::ceil(size.x / grid.cell)) + 4;
    grid.height = static_cast<int>(std::ceil(size.y / grid.cell)) + 4;
    grid.origin = box.lo - Vec2(margin) - grid.cell * kOffGrid;
    return grid;
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

    /// The line with straight ends `more` metres longer. They go on as its last millimetres do: its last edge may be a
    /// short one that a crossing was moved along.
    std::vector<Vec2> extended(double more) const {
        std::vector<Vec2> out = line;
        out.insert(out.begin(), line.front() + more * direction(line.begin(), line.end()));
        out.push_back(line.back() + more * direction(line.rbegin(), line.rend()));
        return out;
    }

    /// Unit, at the first of some points, away from the others.
    static Vec2 direction(auto first, auto end) {
        auto from = first + 1;
        while (from + 1 != end && glm::length(*from - *first) < kEndOfLine) ++from;
        return (*first - *from) / glm::length(*first - *from);
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
        const double reach = label == kNone ? free : label == own ? 0 : std::min(options.overlap(label), free);
        BorderRun run{.line = {}, .reach = reach, .seam = label != kNone && label != own && reach < free};
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
Region film_round(const Grid& grid, const LevelSet& painted, double bleed, double around) {
    LevelSet set{signed_distance(grid, painted)};
    if (around > bleed) {
        for (float& d : set.value) d += static_cast<float>(around);
        set.value = signed_distance(grid, set);
        bleed -= around;
    }
    for (float& d : set.value) d += static_cast<float>(bleed);
    return zero_lines(grid, set);
}

/// Leaves out holes smaller than a disc of radius `radius`.
Region without_small_holes(const Region& region, double radius) {
    Region out;
    for (const Ring& ring : region)
        if (area_of(ring) > 0 || -area_of(ring) > 3.14 * radius * radius) out.push_back(ring);
    return out;
}

/// Rounds the inner corners of each piece by the closing of it alone: pieces apart stay apart. `have`: radius that they
/// have already.
Region round_inner_corners(const Region& film, double bleed, double have) {
    const double radius = std::clamp(kInnerCorner * bleed, kLeastCorner, kMostCorner);
    if (!(bleed > 0) || have >= radius) return film;
    const std::vector<Region> parts = separate(film);
    std::vector<Box2> boxes;
    for (const Region& part : parts) boxes.push_back(box_of(part));
    const auto overlap = [](const Box2& a, const Box2& b) {
        return a.lo.x < b.hi.x && b.lo.x < a.hi.x && a.lo.y < b.hi.y && b.lo.y < a.hi.y;
    };
    Region out;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Region closed = offset(offset(parts[i], radius), -radius);
        for (std::size_t k = 0; k < parts.size(); ++k)
            if (k != i && overlap(boxes[i], boxes[k])) closed = subtract(closed, offset(parts[k], kApart));
        closed = unite(closed, parts[i]);
        out.insert(out.end(), closed.begin(), closed.end());
    }
    return out;
}

}  // namespace

FilmReach film_reach(double bleed, double join) {
    FilmReach reach;
    reach.bleed = std::max(kLeastFilm, std::min(bleed, 0.5 * join + kFlatBleed));
    reach.around = closing_distance(reach.bleed, join);
    reach.hole = hole_radius(reach.bleed, join);
    return reach;
}

std::vector<Outline> find_outlines(const FilmMesh& film, const Panel& panel, const PrintSurface& surface,
                                   const CoverageFn& coverage, const OutlineOptions& options) {
    const double around = closing_distance(options.bleed, options.join);
    const Grid grid = grid_over(surface, around + 2 * kLeastCell, options.texel);
    const PaintField paint = find_paint(surface, coverage, grid, options.texel);
    if (!paint.any) return {};
    const Region allowed = allowed_region(film, panel, options, options.bleed + options.least_side);
    const Region round =
        round_inner_corners(simplify(film_round(grid, paint.painted, options.bleed, around), 0.5 * kStraight),
                            options.bleed, around - options.bleed);
    const Region wanted = simplify(without_small_holes(round, hole_radius(options.bleed, options.join)), kStraight);
    std::vector<Outline> outlines;
    for (Region& part : separate(intersect(wanted, allowed))) {
        const Vec2 size = box_of(part).size();
        const double side = std::min(size.x, size.y);
        if (side < options.least_side) part = intersect(offset(part, 0.5 * (options.least_side - side)), allowed);
        const double area = paint_inside(grid, paint.mean, part);
        if (area > kLeastPaint) outlines.push_back({simplify(part, 0.5 * kStraight), area});
    }
    return outlines;
}

}  // namespace tuft::decal
