#include "stroke/surface/surface_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/segment.h"
#include "stroke/placement/placement.h"

namespace tuft::stroke {
namespace {

constexpr double kPiece = 1e-3;      // metres
constexpr double kMostPieces = 1e5;  // beyond, clusters are longer
constexpr std::uint32_t kRun = 32;   // clusters that are looked at together
constexpr int kBlock = 8;            // cells
constexpr double kSame = 1e-9;       // parts of a distance by which equal ones differ

/// How far a place lies beside the line of an edge, inwards.
double beside(const StencilEdge& e, const Vec2& place) {
    const Vec2 run = e.to - e.from, d = place - e.from;
    const double length = glm::length(run);
    return length > 0 ? (run.x * d.y - run.y * d.x) / length : 0;
}

/// The nearest of some edges. Of two as near, which is off their common end, the one that the place
/// is further beside.
struct Nearest {
    double distance = std::numeric_limits<double>::infinity(), side = 0;

    void meet(double to, double by) {
        const bool nearer = to < distance * (1 - kSame);
        if (nearer || (to <= distance * (1 + kSame) && std::abs(by) > std::abs(side))) distance = to, side = by;
    }
    double inside() const { return side < 0 ? -distance : distance; }
};

/// Cuts a footprint's coverage along edges: boxes of cells by quadrants, each with the edges that
/// may be the nearest to one of its cells.
class Cut {
  public:
    Cut(footprint::Footprint& f, std::span<const StencilEdge> edges) : f_(f), edges_(edges), near_(edges.size()) {
        for (std::uint32_t i = 0; i < edges.size(); ++i) near_[i] = i;
    }
    void all() { box(0, 0, f_.width, f_.height, 0); }

  private:
    /// By the edges in `near_` from `first` on.
    void box(int x0, int y0, int x1, int y1, std::size_t first) {
        if (x0 >= x1 || y0 >= y1) return;
        const Vec2 middle = f_.lo + f_.cell * 0.5 * Vec2(x0 + x1, y0 + y1);
        const double corner = 0.5 * f_.cell * glm::length(Vec2(x1 - x0, y1 - y0));
        const std::size_t end = near_.size();
        Nearest nearest;
        distances_.resize(end);
        for (std::size_t i = first; i < end; ++i) {
            const StencilEdge& e = edges_[near_[i]];
            distances_[i] = segment_distance(e.from, e.to, middle);
            nearest.meet(distances_[i], beside(e, middle));
        }
        if (nearest.distance > corner + f_.cell) {
            if (nearest.side < 0)
                for (int y = y0; y < y1; ++y) std::fill_n(&coverage(x0, y), x1 - x0, std::uint8_t{0});
            return;
        }
        const double most = (nearest.distance + 2 * corner) * (1 + 1e-6);
        for (std::size_t i = first; i < end; ++i)
            if (distances_[i] <= most) near_.push_back(near_[i]);
        if (std::max(x1 - x0, y1 - y0) <= kBlock) {
            cells(x0, y0, x1, y1, end);
        } else {
            const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
            box(x0, y0, x, y, end);
            box(x, y0, x1, y, end);
            box(x0, y, x, y1, end);
            box(x, y, x1, y1, end);
        }
        near_.resize(end);
    }

    void cells(int x0, int y0, int x1, int y1, std::size_t first) {
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                std::uint8_t& c = coverage(x, y);
                if (c == 0) continue;
                const Vec2 place = f_.lo + f_.cell * Vec2(x + 0.5, y + 0.5);
                Nearest nearest;
                for (std::size_t i = first; i < near_.size(); ++i) {
                    const StencilEdge& e = edges_[near_[i]];
                    nearest.meet(segment_distance(e.from, e.to, place), beside(e, place));
                }
                c = static_cast<std::uint8_t>(std::lround(std::clamp(0.5 + nearest.inside() / f_.cell, 0.0, 1.0) * c));
            }
    }

    std::uint8_t& coverage(int x, int y) {
        return f_
            .coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(f_.width) + static_cast<std::size_t>(x)];
    }

    footprint::Footprint& f_;
    std::span<const StencilEdge> edges_;
    std::vector<std::uint32_t> near_;  // of the boxes that are being cut, one after the other
    std::vector<double> distances_;    // of those of the innermost
};

}  // namespace

SurfaceStencil::SurfaceStencil(const mesh::SurfaceQuery& query, const StrokeSamples& trace) {
    if (!trace.flat || trace.stencil.empty()) return;
    StrokeSamples ends{.placement = trace.placement};
    std::vector<Vec2> directions;
    double whole = 0;
    for (const StencilEdge& e : trace.stencil) whole += glm::distance(e.from, e.to);
    const double cluster = std::max(kPiece, whole / kMostPieces);
    for (const StencilEdge& e : trace.stencil) {
        const double length = glm::distance(e.from, e.to);
        if (!(length > 0) || !std::isfinite(whole)) continue;
        const auto n = static_cast<int>(std::ceil(length / cluster));
        for (int i = 0; i <= n; ++i) {
            ends.samples.push_back({.position = Vec3(glm::mix(e.from, e.to, static_cast<double>(i) / n), 0)});
            directions.push_back(i < n ? (e.to - e.from) / length : Vec2(0));
        }
    }
    if (ends.samples.empty()) return;
    const SurfaceTrace on = map_to_surface(query, ends);
    for (std::size_t i = 0; i + 1 < on.samples.size(); ++i) {
        const SurfaceSample &a = on.samples[i], &b = on.samples[i + 1];
        if (directions[i] == Vec2(0) || !a.on_surface || !b.on_surface) continue;
        pieces_.push_back({a.position, b.position, directions[i].x * a.down - directions[i].y * a.right});
    }
    find_clusters();
}

void SurfaceStencil::find_clusters() {
    const auto n = static_cast<std::uint32_t>(pieces_.size());
    for (std::uint32_t begin = 0; begin < n; begin += kRun) {
        Run run{begin, std::min(begin + kRun, n), Vec3(0), 0};
        for (std::uint32_t i = begin; i < run.end; ++i) run.centre += 0.5 * (pieces_[i].from + pieces_[i].to);
        run.centre /= static_cast<double>(run.end - begin);
        for (std::uint32_t i = begin; i < run.end; ++i)
            run.radius = std::max(
                {run.radius, glm::distance(run.centre, pieces_[i].from), glm::distance(run.centre, pieces_[i].to)});
        runs_.push_back(run);
    }
}

double inside_stencil(std::span<const StencilEdge> edges, const Vec2& point) {
    Nearest nearest;
    for (const StencilEdge& e : edges) nearest.meet(segment_distance(e.from, e.to, point), beside(e, point));
    return nearest.inside();
}

/// The clusters that come near to a footprint, in its plane.
std::vector<StencilEdge> SurfaceStencil::seen_from(const footprint::Footprint& f, double reach) const {
    std::vector<StencilEdge> seen;
    for (const Run& run : runs_) {
        if (glm::distance(run.centre, f.frame.origin) - run.radius > 4 * reach) continue;
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const StencilSegment& cluster = pieces_[i];
            const Vec3 a = f.frame.to_local(cluster.from), b = f.frame.to_local(cluster.to);
            if (std::max(std::abs(a.z), std::abs(b.z)) > 2 * reach) continue;
            // What is nearest to any cell is no further than three times the reach.
            if (segment_distance(Vec2(a), Vec2(b), Vec2(0)) > 3 * reach) continue;
            const Vec2 inward(glm::dot(cluster.inward, f.frame.t), glm::dot(cluster.inward, f.frame.b));
            const StencilEdge e{Vec2(a), Vec2(b)};
            seen.push_back(beside(e, e.from + inward) < 0 ? StencilEdge{e.to, e.from} : e);
        }
    }
    return seen;
}

void SurfaceStencil::cut_off(footprint::Footprint& f) const {
    if (f.empty() || empty()) return;
    // Of the place nearest to the origin: by it lies what has no stencil edge across it.
    Nearest nearest;
    const Vec3& origin = f.frame.origin;
    for (const Run& run : runs_) {
        if (glm::distance(run.centre, origin) - run.radius > nearest.distance * (1 + kSame)) continue;
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            nearest.meet(segment_distance(pieces_[i].from, pieces_[i].to, origin),
                         glm::dot(origin - pieces_[i].from, pieces_[i].inward));
    }
    const double reach = f.radius + 2 * f.cell;
    if (nearest.distance > reach) {
        if (nearest.side < 0) std::fill(f.coverage.begin(), f.coverage.end(), std::uint8_t{0});
        return;
    }
    const std::vector<StencilEdge> seen = seen_from(f, reach);
    Cut(f, seen).all();
}

}  // namespace tuft::stroke
