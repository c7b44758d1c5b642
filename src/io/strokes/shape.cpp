#include "io/strokes/shape.h"

#include <algorithm>
#include <cmath>
#include <polyclipping/clipper.hpp>
#include <utility>

#include "core/geometry/plane_vectors.h"
#include "core/geometry/segment.h"

namespace tuft::io {
namespace {

namespace clip = ClipperLib;

/// Metres to the grid that Clipper counts in. Its products stay within 64 bits up to 2³⁰; a power
/// of two, so that a shape in another size has the same rings.
struct Grid {
    Vec2 centre{0};
    double scale = 0;  // 0: no extent, or none that is finite

    explicit Grid(std::span<const Ring> rings) {
        Vec2 low(HUGE_VAL), high(-HUGE_VAL);
        for (const Ring& ring : rings)
            for (const Vec2& p : ring) {
                if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
                low = glm::min(low, p), high = glm::max(high, p);
            }
        const double extent = std::max(high.x - low.x, high.y - low.y);
        if (!(extent > 0) || !std::isfinite(extent)) return;
        centre = low + 0.5 * (high - low);
        scale = std::ldexp(1.0, 29 - std::ilogb(extent));
        if (!std::isfinite(scale)) scale = 0;
    }
    clip::Paths paths(std::span<const Ring> rings) const {
        clip::Paths paths;
        for (const Ring& ring : rings) {
            clip::Path path;
            for (const Vec2& p : ring) {
                const Vec2 at = scale * (p - centre);
                path.emplace_back(std::llround(at.x), std::llround(at.y));
            }
            paths.push_back(std::move(path));
        }
        return paths;
    }
    std::vector<Ring> rings(const clip::Paths& paths) const {
        std::vector<Ring> rings;
        for (const clip::Path& path : paths) {
            Ring ring;
            for (const clip::IntPoint& p : path) ring.push_back(centre + Vec2(double(p.X), double(p.Y)) / scale);
            if (ring.size() > 2) rings.push_back(std::move(ring));
        }
        return rings;
    }
};

/// Whether edges cross at more than `most` places: Clipper keeps every one of them.
bool crosses_more_than(std::size_t most, std::span<const Ring> rings) {
    std::vector<std::pair<Vec2, Vec2>> edges;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            edges.emplace_back(a.x <= b.x ? a : b, a.x <= b.x ? b : a);
        }
    std::sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.first.x < b.first.x; });
    std::size_t n = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [a, b] = edges[i];
        for (std::size_t j = i + 1; j < edges.size() && edges[j].first.x <= b.x; ++j) {
            const auto& [c, d] = edges[j];
            if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) continue;
            const bool apart =
                cross(b - a, c - a) * cross(b - a, d - a) >= 0 || cross(d - c, a - c) * cross(d - c, b - c) >= 0;
            if (!apart && ++n > most) return true;
        }
    }
    return false;
}

std::vector<Ring> united(const Grid& grid, const clip::Paths& paths, clip::PolyFillType rule) {
    clip::Clipper clipper;
    clipper.AddPaths(paths, clip::ptSubject, true);
    clip::Paths out;
    clipper.Execute(clip::ctUnion, out, rule, rule);
    return grid.rings(out);
}

/// The points of the path from `first` to `last` (past the end it begins anew) that are needed are
/// marked.
void mark_needed(const Ring& ring, std::size_t first, std::size_t last, double tolerance, std::vector<bool>& needed) {
    std::vector<std::pair<std::size_t, std::size_t>> ranges{{first, last}};
    const auto at = [&](std::size_t i) -> const Vec2& { return ring[i % ring.size()]; };
    while (!ranges.empty()) {
        const auto [from, to] = ranges.back();
        ranges.pop_back();
        double farthest = tolerance;
        std::size_t split = from;
        for (std::size_t i = from + 1; i < to; ++i)
            if (const double d = segment_distance(at(from), at(to), at(i)); d > farthest) farthest = d, split = i;
        if (split == from) continue;
        needed[split % ring.size()] = true;
        ranges.emplace_back(from, split);
        ranges.emplace_back(split, to);
    }
}

}  // namespace

Shape::Shape(std::span<const Ring> rings, FillRule rule) {
    std::size_t n = 0;
    for (const Ring& ring : rings) n += ring.size();
    const Grid grid(rings);
    too_large_ = n > kMostPoints || crosses_more_than(kMostPoints, rings);
    if (too_large_ || grid.scale == 0) return;
    rings_ = united(grid, grid.paths(rings), rule == FillRule::nonzero ? clip::pftNonZero : clip::pftEvenOdd);
}

double Shape::area() const {
    double sum = 0;
    for (const Ring& ring : rings_)
        for (std::size_t i = 0; i < ring.size(); ++i)
            sum += 0.5 * cross(ring[i] - ring[0], ring[i + 1 < ring.size() ? i + 1 : 0] - ring[0]);
    return sum;
}

double Shape::perimeter() const {
    double sum = 0;
    for (const Ring& ring : rings_)
        for (std::size_t i = 0; i < ring.size(); ++i)
            sum += glm::distance(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
    return sum;
}

bool Shape::contains(const Vec2& p) const {
    bool inside = false;
    for (const Ring& ring : rings_)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if ((a.y <= p.y) != (b.y <= p.y) && (cross(b - a, p - a) > 0) == (b.y > a.y)) inside = !inside;
        }
    return inside;
}

Shape Shape::simplified(double tolerance) const {
    std::vector<Ring> fewer;
    for (const Ring& ring : rings_) {
        // From the point of lowest x and the one farthest from it.
        const auto less = [](const Vec2& a, const Vec2& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
        const auto first = static_cast<std::size_t>(std::min_element(ring.begin(), ring.end(), less) - ring.begin());
        std::size_t last = first;
        for (std::size_t i = 0; i < ring.size(); ++i)
            if (glm::distance(ring[i], ring[first]) > glm::distance(ring[last], ring[first])) last = i;
        if (last < first) last += ring.size();
        std::vector<bool> needed(ring.size(), false);
        needed[first] = needed[last % ring.size()] = true;
        mark_needed(ring, first, last, tolerance, needed);
        mark_needed(ring, last, first + ring.size(), tolerance, needed);
        Ring kept;
        for (std::size_t i = 0; i < ring.size(); ++i)
            if (needed[i]) kept.push_back(ring[i]);
        if (kept.size() > 2) fewer.push_back(std::move(kept));
    }
    Shape shape;
    if (const Grid grid(fewer); grid.scale > 0) shape.rings_ = united(grid, grid.paths(fewer), clip::pftPositive);
    return shape;
}

template <class Operation>
Shape Shape::combined(const Shape& other, Operation operation) const {
    std::vector<Ring> all = rings_;
    all.insert(all.end(), other.rings_.begin(), other.rings_.end());
    std::size_t n = 0;
    for (const Ring& ring : all) n += ring.size();
    Shape shape;
    const Grid grid(all);
    shape.too_large_ = n > kMostPoints || crosses_more_than(kMostPoints, all);
    if (shape.too_large_ || grid.scale == 0) return shape;
    clip::Clipper clipper;
    clipper.AddPaths(grid.paths(rings_), clip::ptSubject, true);
    clipper.AddPaths(grid.paths(other.rings_), clip::ptClip, true);
    clip::Paths out;
    clipper.Execute(operation, out, clip::pftNonZero, clip::pftNonZero);
    shape.rings_ = grid.rings(out);
    return shape;
}

Shape Shape::intersected(const Shape& other) const {
    if (!empty() && !other.empty()) return combined(other, clip::ctIntersection);
    Shape none;
    none.too_large_ = too_large_ || other.too_large_;
    return none;
}

Shape Shape::without(const Shape& other) const {
    return empty() || other.empty() ? *this : combined(other, clip::ctDifference);
}

Shape Shape::grown(double d, double tolerance) const {
    return moved_outline(d, 1, tolerance);
}

Shape Shape::inset(double d, double tolerance) const {
    return moved_outline(d, -1, tolerance);
}

Shape Shape::moved_outline(double d, int outward, double tolerance) const {
    // A jagged outline crosses itself at d over the distance of its points: small steps first, each
    // of which leaves fewer points to the next, twice as long.
    const double first = 2 * tolerance;
    const int steps = 1 + std::max(0, static_cast<int>(std::ceil(std::log2(std::max(d / first, 1.0)))));
    const double part = tolerance / (2 * steps);
    Shape shape = *this;
    double done = 0;
    for (int i = 0; i < steps && !shape.empty(); ++i) {
        const double next = i + 1 < steps ? first * std::ldexp(1.0, i) : d;
        std::vector<Ring> extent = shape.rings_;  // the grid has no points beyond it
        if (outward > 0)
            for (const Ring& ring : shape.rings_)
                for (const Vec2& p : ring) extent.push_back({p - (next - done), p + (next - done)});
        const Grid grid(extent);
        clip::ClipperOffset offset(2, std::max(0.25, part * grid.scale));
        offset.AddPaths(grid.paths(shape.rings_), clip::jtRound, clip::etClosedPolygon);
        clip::Paths out;
        offset.Execute(out, outward * (next - done) * grid.scale);
        shape.rings_ = grid.rings(out);
        shape = shape.simplified(part);
        done = next;
    }
    return shape;
}

}  // namespace tuft::io
