#include "stroke/painting/tape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stroke/hand/placement.h"

namespace tuft::stroke {
namespace {

constexpr double kPiece = 1e-3;      // metres
constexpr double kMostPieces = 1e5;  // beyond, pieces are longer
constexpr int kBlock = 8;        // cells that are looked at together
constexpr double kSame = 1e-9;   // parts of a distance by which equal ones differ

/// Distance of a place to an edge, and how far it lies beside the edge's line, inwards.
struct Beside {
    double distance, side;
};
Beside beside(const TapeEdge& e, const Vec2& place) {
    const Vec2 way = e.to - e.from, d = place - e.from;
    const double length2 = glm::dot(way, way);
    const double u = length2 > 0 ? std::clamp(glm::dot(d, way) / length2, 0.0, 1.0) : 0.0;
    return {glm::length(d - u * way),
            length2 > 0 ? (way.x * d.y - way.y * d.x) / std::sqrt(length2) : 0.0};
}

}  // namespace

std::vector<LaidTape> lay_tape(const mesh::SurfaceQuery& query, const Trace& trace) {
    std::vector<LaidTape> laid;
    if (!trace.flat || trace.tape.empty()) return laid;
    Trace ends{.placement = trace.placement};
    std::vector<Vec2> ways;
    double whole = 0;
    for (const TapeEdge& e : trace.tape) whole += glm::distance(e.from, e.to);
    const double piece = std::max(kPiece, whole / kMostPieces);
    for (const TapeEdge& e : trace.tape) {
        const double length = glm::distance(e.from, e.to);
        if (!(length > 0) || !std::isfinite(whole)) continue;
        const auto n = static_cast<int>(std::ceil(length / piece));
        for (int i = 0; i <= n; ++i) {
            ends.samples.push_back(
                {.position = Vec3(glm::mix(e.from, e.to, static_cast<double>(i) / n), 0)});
            ways.push_back(i < n ? (e.to - e.from) / length : Vec2(0));
        }
    }
    if (ends.samples.empty()) return laid;
    const LaidTrace on = lay(query, ends);
    for (std::size_t i = 0; i + 1 < on.samples.size(); ++i) {
        const LaidSample &a = on.samples[i], &b = on.samples[i + 1];
        if (ways[i] == Vec2(0) || !a.on_surface || !b.on_surface) continue;
        laid.push_back({a.position, b.position, ways[i].x * a.down - ways[i].y * a.right});
    }
    return laid;
}

double inside_tape(std::span<const TapeEdge> tape, const Vec2& place) {
    Beside nearest{std::numeric_limits<double>::infinity(), 1};
    for (const TapeEdge& e : tape) {
        const Beside b = beside(e, place);
        const bool nearer = b.distance < nearest.distance * (1 - kSame);
        if (nearer || (b.distance <= nearest.distance * (1 + kSame) &&
                       std::abs(b.side) > std::abs(nearest.side)))
            nearest = b;
    }
    return nearest.side < 0 ? -nearest.distance : nearest.distance;
}

void cut_off(footprint::Footprint& f, std::span<const LaidTape> tape) {
    if (f.empty()) return;
    // Of the place nearest to the origin: by it lies what has no tape across it.
    double distance = std::numeric_limits<double>::infinity(), side = 0;
    for (const LaidTape& piece : tape) {
        const Vec3 way = piece.to - piece.from, d = f.frame.origin - piece.from;
        const double u = std::clamp(glm::dot(d, way) / glm::dot(way, way), 0.0, 1.0),
                     to = glm::length(d - u * way);
        const double by = glm::dot(d, piece.inward);
        const bool nearer = to < distance * (1 - kSame);
        if (nearer || (to <= distance * (1 + kSame) && std::abs(by) > std::abs(side)))
            distance = to, side = by;
    }
    const double reach = f.radius + 2 * f.cell;
    if (distance > reach) {
        if (side < 0) std::fill(f.coverage.begin(), f.coverage.end(), std::uint8_t{0});
        return;
    }
    // What is nearest to any cell is no further than three times that.
    std::vector<TapeEdge> near;
    for (const LaidTape& piece : tape) {
        const Vec3 a = f.frame.to_local(piece.from), b = f.frame.to_local(piece.to);
        if (std::max(std::abs(a.z), std::abs(b.z)) > 2 * reach) continue;
        if (std::min(glm::length(Vec2(a)), glm::length(Vec2(b))) > 3 * reach + glm::length(Vec2(b - a))) continue;
        const Vec2 inward(glm::dot(piece.inward, f.frame.t), glm::dot(piece.inward, f.frame.b));
        const TapeEdge e{Vec2(a), Vec2(b)};
        const Vec2 way = e.to - e.from;
        near.push_back(way.x * inward.y - way.y * inward.x < 0 ? TapeEdge{e.to, e.from} : e);
    }
    const double corner = 0.5 * std::numbers::sqrt2 * kBlock * f.cell;
    for (int y = 0; y < f.height; y += kBlock)
        for (int x = 0; x < f.width; x += kBlock) {
            const int to_x = std::min(x + kBlock, f.width), to_y = std::min(y + kBlock, f.height);
            const double d =
                inside_tape(near, f.lo + f.cell * Vec2(x + 0.5 * kBlock, y + 0.5 * kBlock));
            if (d > corner + f.cell) continue;
            for (int j = y; j < to_y; ++j)
                for (int i = x; i < to_x; ++i) {
                    std::uint8_t& c =
                        f.coverage[static_cast<std::size_t>(j) * static_cast<std::size_t>(f.width) +
                                   static_cast<std::size_t>(i)];
                    if (c == 0) continue;
                    const double stays =
                        d < -corner - f.cell
                            ? 0
                            : std::clamp(
                                  0.5 + inside_tape(near, f.lo + f.cell * Vec2(i + 0.5, j + 0.5)) /
                                            f.cell,
                                  0.0, 1.0);
                    c = static_cast<std::uint8_t>(std::lround(stays * c));
                }
        }
}

}  // namespace tuft::stroke
