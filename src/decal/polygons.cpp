#include "decal/polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <polyclipping/clipper.hpp>

#include "core/geometry/segment.h"

namespace tuft::decal {
namespace {

namespace clip = ClipperLib;

constexpr double kSteps = 1e7;        // per metre
constexpr double kArcTolerance = 50;  // steps, 5 µm

clip::Path path_of(const std::vector<Vec2>& points) {
    clip::Path path;
    path.reserve(points.size());
    for (const Vec2& p : points) path.emplace_back(std::llround(kSteps * p.x), std::llround(kSteps * p.y));
    return path;
}

clip::Paths paths_of(const Region& region) {
    clip::Paths paths;
    for (const Ring& ring : region) paths.push_back(path_of(ring));
    return paths;
}

Ring ring_of(const clip::Path& path) {
    Ring ring;
    ring.reserve(path.size());
    for (const clip::IntPoint& p : path)
        ring.emplace_back(static_cast<double>(p.X) / kSteps, static_cast<double>(p.Y) / kSteps);
    return ring;
}

Region region_of(const clip::Paths& paths) {
    Region region;
    for (const clip::Path& path : paths)
        if (path.size() > 2) region.push_back(ring_of(path));
    return region;
}

Region combine(const Region& a, const Region& b, clip::ClipType how) {
    clip::Clipper clipper;
    clipper.AddPaths(paths_of(a), clip::ptSubject, true);
    clipper.AddPaths(paths_of(b), clip::ptClip, true);
    clip::Paths out;
    clipper.Execute(how, out, clip::pftPositive, clip::pftPositive);
    return region_of(out);
}

Region inflated(const clip::Paths& paths, clip::EndType end, double distance) {
    clip::ClipperOffset offset(2, kArcTolerance);
    offset.AddPaths(paths, clip::jtRound, end);
    clip::Paths out;
    offset.Execute(out, kSteps * distance);
    return region_of(out);
}

/// The points of a closed ring that Douglas and Peucker's method needs.
Ring simplified(const Ring& ring, double tolerance) {
    if (ring.size() < 5) return ring;
    std::size_t far = 0;
    for (std::size_t i = 1; i < ring.size(); ++i)
        if (glm::length(ring[i] - ring[0]) > glm::length(ring[far] - ring[0])) far = i;
    std::vector<std::uint8_t> needed(ring.size(), 0);
    needed[0] = needed[far] = 1;
    std::vector<std::pair<std::size_t, std::size_t>> ranges{{0, far}, {far, ring.size()}};
    while (!ranges.empty()) {
        const auto [from, to] = ranges.back();
        ranges.pop_back();
        double most = tolerance;
        std::size_t split = from;
        for (std::size_t i = from + 1; i < to; ++i)
            if (const double d = segment_distance(ring[from], ring[to % ring.size()], ring[i]); d > most)
                most = d, split = i;
        if (split == from) continue;
        needed[split] = 1;
        ranges.emplace_back(from, split);
        ranges.emplace_back(split, to);
    }
    Ring out;
    for (std::size_t i = 0; i < ring.size(); ++i)
        if (needed[i]) out.push_back(ring[i]);
    return out;
}

}  // namespace

double area_of(const Ring& ring) {
    double area = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return area;
}

double area_of(const Region& region) {
    double area = 0;
    for (const Ring& ring : region) area += area_of(ring);
    return area;
}

Region unite(const Region& a, const Region& b) {
    return combine(a, b, clip::ctUnion);
}

Region intersect(const Region& a, const Region& b) {
    return combine(a, b, clip::ctIntersection);
}

Region subtract(const Region& a, const Region& b) {
    return combine(a, b, clip::ctDifference);
}

Region offset(const Region& region, double distance) {
    if (distance == 0) return region;
    if (distance > 0) return inflated(paths_of(region), clip::etClosedPolygon, distance);
    // Clipper's own inward offset leaves spikes as long as the distance where an arc of many points shrinks to its
    // centre: what lies within the distance of the border is taken away instead.
    const Region border = simplify(region, kArcTolerance / kSteps);
    return subtract(border, inflated(paths_of(border), clip::etClosedLine, -distance));
}

Region sweep(const std::vector<Vec2>& line, double distance) {
    return inflated({path_of(line)}, clip::etOpenButt, distance);
}

Region simplify(const Region& region, double tolerance) {
    Region out;
    for (const Ring& ring : region)
        if (Ring s = simplified(ring, tolerance); s.size() > 2) out.push_back(std::move(s));
    return out;
}

bool contains(const Region& region, const Vec2& p) {
    int winding = 0;
    for (const Ring& ring : region)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
            if ((a.y <= p.y) == (b.y <= p.y)) continue;
            const double x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            if (x > p.x) winding += b.y > a.y ? 1 : -1;
        }
    return winding > 0;
}

std::vector<Region> separate(const Region& region) {
    std::vector<Region> parts;
    for (const Ring& ring : region)
        if (area_of(ring) > 0) parts.push_back({ring});
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Region& a, const Region& b) { return area_of(a[0]) > area_of(b[0]); });
    for (const Ring& ring : region) {
        if (area_of(ring) > 0) continue;
        for (auto part = parts.rbegin(); part != parts.rend(); ++part)  // the smallest that holds it
            if (contains({(*part)[0]}, ring[0])) {
                part->push_back(ring);
                break;
            }
    }
    return parts;
}

Box2 box_of(const Region& region) {
    Box2 box{Vec2(std::numeric_limits<double>::infinity()), Vec2(-std::numeric_limits<double>::infinity())};
    for (const Ring& ring : region)
        for (const Vec2& p : ring) box.lo = glm::min(box.lo, p), box.hi = glm::max(box.hi, p);
    return box;
}

}  // namespace tuft::decal
