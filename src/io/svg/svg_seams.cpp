#include "io/svg/svg_seams.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/segment.h"
#include "core/system/interrupt.h"
#include "io/strokes/shape.h"

namespace tuft::io {
namespace {

using stroke::FlatArea;

constexpr int kCells = 256;  // along the drawing's larger side; wider than `kSharedEdge`

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
        std::ranges::sort(entries_, {}, &Entry::cell);
    }

    /// Calls `found` with each area that has an edge within `distance` of a point; less than a cell.
    template <class Found>
    void near(const Vec2& p, double distance, const Found& found) const {
        const auto [x, y] = cell_of(p);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const auto all = std::ranges::equal_range(entries_, key(x + dx, y + dy), {}, &Entry::cell);
                for (const Entry& e : all)
                    if (segment_distance(edges_[e.edge].from, edges_[e.edge].to, p) <= distance)
                        found(edges_[e.edge].area);
            }
    }

  private:
    struct Edge {
        Vec2 from, to;
        std::uint32_t area;
    };
    struct Entry {
        std::int64_t cell;
        std::uint32_t edge;
    };

    std::pair<std::int64_t, std::int64_t> cell_of(const Vec2& p) const {
        const Vec2 q = glm::floor((p - low_) / cell_);
        return {static_cast<std::int64_t>(q.x), static_cast<std::int64_t>(q.y)};
    }
    static std::int64_t key(std::int64_t x, std::int64_t y) { return (y + 4) * (4 * kCells) + x + 4; }

    void add(std::uint32_t area, const Vec2& from, const Vec2& to) {
        const auto edge = static_cast<std::uint32_t>(edges_.size());
        edges_.push_back({from, to, area});
        // Half a cell apart: no point of the edge is more than a quarter of a cell from one of them.
        const int n = std::max(1, static_cast<int>(std::ceil(2 * glm::distance(from, to) / cell_)));
        std::int64_t last = -1;
        for (int k = 0; k <= n; ++k) {
            const auto [x, y] = cell_of(glm::mix(from, to, static_cast<double>(k) / n));
            if (std::exchange(last, key(x, y)) != key(x, y)) entries_.push_back({last, edge});
        }
    }

    Vec2 low_;
    double cell_;
    std::vector<Edge> edges_;
    std::vector<Entry> entries_;
};

/// Pairs of areas, the earlier first, that share an edge or touch.
std::set<std::pair<std::uint32_t, std::uint32_t>> touching(std::span<FlatArea* const> areas, const EdgeGrid& grid,
                                                           double distance) {
    // Both ends of a shared piece of an edge are corners of one of its areas.
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t i = 0; i < areas.size(); ++i) {
        check_interrupt();
        for (const Ring& ring : areas[i]->rings)
            for (const Vec2& p : ring)
                grid.near(p, distance, [&](std::uint32_t j) {
                    if (i != j) pairs.insert(std::minmax(i, j));
                });
    }
    return pairs;
}

}  // namespace

void set_under(std::span<FlatArea* const> areas) {
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const FlatArea* area : areas)
        for (const Ring& ring : area->rings)
            for (const Vec2& p : ring) low = glm::min(low, p), high = glm::max(high, p);
    const double side = std::max(high.x - low.x, high.y - low.y);
    if (!(side > 0 && std::isfinite(side))) return;
    const double shared = kSharedEdge * side, depth = kUnderDepth * side;
    const auto pairs = touching(areas, EdgeGrid(areas, low, side), shared);
    for (auto pair = pairs.begin(); pair != pairs.end();) {
        check_interrupt();
        const std::uint32_t i = pair->first;
        std::vector<Ring> rings;
        for (; pair != pairs.end() && pair->first == i; ++pair) {
            if (!covers(*areas[pair->second])) continue;
            const Shape later = shape_of(*areas[pair->second]);
            rings.insert(rings.end(), later.rings().begin(), later.rings().end());
        }
        if (rings.empty() || !areas[i]->lines.empty()) continue;
        const Shape over(rings, FillRule::nonzero), area = shape_of(*areas[i]);
        const Shape edge = area.without(over).grown(shared, 0.1 * shared).intersected(over).without(area);
        areas[i]->under = edge.grown(depth, 0.05 * depth).intersected(over).without(area).rings();
    }
}

}  // namespace tuft::io
