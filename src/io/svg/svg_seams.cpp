#include "io/svg/svg_seams.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/segment.h"
#include "core/system/interrupt.h"
#include "io/strokes/shape.h"

namespace tuft::io {
namespace {

using stroke::FlatArea;

constexpr int kCells = 256;                         // along the drawing's larger side; wider than `kSharedEdge`
constexpr double kMostEntries = 1 << 24;            // of the grid
constexpr std::size_t kMostCompared = 200'000'000;  // pairs of a corner and an edge

bool covers(const FlatArea& area) {
    return area.lines.empty() && area.gradient != stroke::AreaGradient::image &&
           std::ranges::all_of(area.stops, [](const stroke::AreaStop& s) { return s.opacity >= 1 && s.film < 0; });
}

Shape shape_of(const FlatArea& area) {
    return {area.rings, area.even_odd ? FillRule::even_odd : FillRule::nonzero};
}

/// The edges of all areas by cells of a grid.
class EdgeGrid {
  public:
    EdgeGrid(std::span<FlatArea* const> areas, const Vec2& low, double side) : low_(low), cell_(side / kCells) {
        for (std::uint32_t i = 0; i < areas.size(); ++i)
            for (const Ring& ring : areas[i]->rings)
                for (std::size_t k = 0; k < ring.size(); ++k) add(i, ring[k], ring[k + 1 < ring.size() ? k + 1 : 0]);
        std::ranges::sort(entries_, {}, [](const Entry& e) { return std::pair(e.cell, e.area); });
    }

    /// Calls `found` with each area but `own` that has an edge within `distance` of a point; less than a cell. Returns
    /// the number of edges that were compared.
    template <class Found>
    std::size_t near(const Vec2& p, std::uint32_t own, double distance, const Found& found) const {
        std::size_t compared = 0;
        const auto [x, y] = cell_of(p);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const auto cell = key(x + dx, y + dy);
                const auto end = std::ranges::upper_bound(entries_, cell, {}, &Entry::cell);
                for (auto e = std::ranges::lower_bound(entries_, cell, {}, &Entry::cell); e != end; ++e) {
                    const Edge& edge = edges_[e->edge];
                    const bool is_near = e->area != own && segment_distance(edge.from, edge.to, p) <= distance;
                    ++compared;
                    if (is_near) found(e->area);
                    if (is_near || e->area == own)  // on to the next area
                        e = std::prev(std::ranges::upper_bound(e, end, e->area, {}, &Entry::area));
                }
            }
        return compared;
    }

  private:
    struct Edge {
        Vec2 from, to;
    };
    struct Entry {
        std::int64_t cell;
        std::uint32_t area, edge;
    };

    std::pair<std::int64_t, std::int64_t> cell_of(const Vec2& p) const {
        const Vec2 q = glm::floor((p - low_) / cell_);
        return {static_cast<std::int64_t>(q.x), static_cast<std::int64_t>(q.y)};
    }
    static std::int64_t key(std::int64_t x, std::int64_t y) { return (y + 4) * (4 * kCells) + x + 4; }

    void add(std::uint32_t area, const Vec2& from, const Vec2& to) {
        const auto edge = static_cast<std::uint32_t>(edges_.size());
        edges_.push_back({from, to});
        // Half a cell apart: no point of the edge is more than a quarter of a cell from one of them.
        const int n = std::max(1, static_cast<int>(std::ceil(2 * glm::distance(from, to) / cell_)));
        std::int64_t last = -1;
        for (int k = 0; k <= n; ++k) {
            const auto [x, y] = cell_of(glm::mix(from, to, static_cast<double>(k) / n));
            if (std::exchange(last, key(x, y)) != key(x, y)) entries_.push_back({last, area, edge});
        }
    }

    Vec2 low_;
    double cell_;
    std::vector<Edge> edges_;
    std::vector<Entry> entries_;
};

/// Pairs of areas, the earlier first, that share an edge or touch. None of a drawing that asks for too many
/// comparisons.
std::set<std::pair<std::uint32_t, std::uint32_t>> touching(std::span<FlatArea* const> areas, const EdgeGrid& grid,
                                                           double distance) {
    // Both ends of a shared piece of an edge are corners of one of its areas.
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::size_t compared = 0, checked = 0;
    for (std::uint32_t i = 0; i < areas.size(); ++i)
        for (const Ring& ring : areas[i]->rings)
            for (const Vec2& p : ring) {
                compared += grid.near(p, i, distance, [&](std::uint32_t j) { pairs.insert(std::minmax(i, j)); });
                if (compared > kMostCompared) return {};
                if (compared - checked > 100'000) checked = compared, check_interrupt();
            }
    return pairs;
}

}  // namespace

void set_under(std::span<FlatArea* const> all) {
    std::vector<FlatArea*> areas;
    for (FlatArea* area : all) {
        std::size_t n = 0;
        for (const Ring& ring : area->rings) n += ring.size();
        if (n <= Shape::kMostPoints) areas.push_back(area);
    }
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const FlatArea* area : areas)
        for (const Ring& ring : area->rings)
            for (const Vec2& p : ring) low = glm::min(low, p), high = glm::max(high, p);
    const double side = std::max(high.x - low.x, high.y - low.y);
    if (!(side > 0 && std::isfinite(side))) return;
    double entries = 0;
    for (const FlatArea* area : areas)
        for (const Ring& ring : area->rings)
            for (std::size_t k = 0; k < ring.size(); ++k)
                entries += 2 + 2 * kCells * glm::distance(ring[k], ring[k + 1 < ring.size() ? k + 1 : 0]) / side;
    if (!(entries <= kMostEntries)) return;
    const double shared = kSharedEdge * side, depth = kUnderDepth * side;
    std::vector<std::optional<Shape>> shapes(areas.size());
    const auto shape_at = [&](std::uint32_t i) -> const Shape& {
        check_interrupt();
        return shapes[i] ? *shapes[i] : shapes[i].emplace(shape_of(*areas[i]));
    };
    const auto pairs = touching(areas, EdgeGrid(areas, low, side), shared);
    for (auto pair = pairs.begin(); pair != pairs.end();) {
        check_interrupt();
        const std::uint32_t i = pair->first;
        std::vector<Ring> rings;
        for (; pair != pairs.end() && pair->first == i; ++pair) {
            if (!covers(*areas[pair->second])) continue;
            const Shape& later = shape_at(pair->second);
            rings.insert(rings.end(), later.rings().begin(), later.rings().end());
        }
        if (rings.empty() || !areas[i]->lines.empty()) continue;
        const Shape over(rings, FillRule::nonzero), &area = shape_at(i);
        const Shape edge = area.without(over).grown(shared, 0.1 * shared).intersected(over).without(area);
        areas[i]->under = edge.grown(depth, 0.05 * depth).intersected(over).without(area).rings();
    }
}

}  // namespace tuft::io
