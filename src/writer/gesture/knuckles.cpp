#include "writer/gesture/knuckles.h"

#include <algorithm>
#include <cmath>

namespace tuft::writer {
namespace {

constexpr double kSoft = 6;     // units along the edge
constexpr double kApart = 2;    // units between points of it
constexpr double kNear = 30;    // units from a knuckle within which a turn of the area explains it
constexpr double kAlike = 0.5;  // part of a knuckle's curvature that such a turn has

/// The line at coverage ½ as rings, the area on the left: where it crosses from one centre of a cell to the next.
std::vector<Ring> edges_of(const Cells& frame, std::span<const float> coverage) {
    Cells cells = frame;
    for (std::size_t k = 0; k < coverage.size(); ++k) cells.inside[k] = coverage[k] > 0.5f;
    const auto value = [&](const Vec2& p) -> double {
        const Vec2 cell = glm::floor((p - frame.lo) / frame.cell);
        const auto i = static_cast<int>(cell.x), j = static_cast<int>(cell.y);
        if (i < 0 || j < 0 || i >= frame.width || j >= frame.height) return 0;
        return static_cast<double>(coverage[std::size_t(j) * frame.width + static_cast<std::size_t>(i)]);
    };
    std::vector<Ring> rings;
    for (const Ring& corners : boundaries(cells, 0)) {
        Ring& ring = rings.emplace_back();
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 a = corners[k], b = corners[k + 1 < corners.size() ? k + 1 : 0];
            const Vec2 to_left = 0.5 * Vec2(a.y - b.y, b.x - a.x), middle = 0.5 * (a + b);
            const double in = value(middle + to_left), out = value(middle - to_left);
            ring.push_back(middle + (1 - 2 * (in - 0.5) / std::max(in - out, 1e-9)) * to_left);
        }
    }
    return rings;
}

/// Points of a ring about `kApart` apart.
Ring resampled_ring(const Ring& ring) {
    std::vector<double> along{0};
    for (std::size_t i = 0; i < ring.size(); ++i)
        along.push_back(along.back() + glm::distance(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]));
    const auto n = static_cast<std::size_t>(std::lround(along.back() / kApart));
    Ring out;
    for (std::size_t k = 0, i = 0; k < n; ++k) {
        const double at = along.back() * static_cast<double>(k) / static_cast<double>(n);
        while (along[i + 1] < at) ++i;
        const double piece = along[i + 1] - along[i];
        out.push_back(
            glm::mix(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0], piece > 0 ? (at - along[i]) / piece : 0));
    }
    return out;
}

}  // namespace

std::vector<float> coverage_of(const Cells& cells) {
    return {cells.inside.begin(), cells.inside.end()};
}

std::vector<float> softened_coverage(const Cells& c, std::span<const float> coverage) {
    std::vector<float> rows(coverage.size(), 0), out(coverage.size(), 0);
    const auto w = static_cast<std::size_t>(c.width), n = coverage.size();
    for (std::size_t k = 1; k + 1 < n; ++k)
        rows[k] = 0.25f * coverage[k - 1] + 0.5f * coverage[k] + 0.25f * coverage[k + 1];
    for (std::size_t k = w; k + w < n; ++k) out[k] = 0.25f * rows[k - w] + 0.5f * rows[k] + 0.25f * rows[k + w];
    return out;
}

std::vector<EdgeTurn> edge_turns(const Cells& frame, std::span<const float> coverage, double least) {
    constexpr int kPasses = static_cast<int>(2 * (kSoft / kApart) * (kSoft / kApart));  // each adds ½ to the variance
    std::vector<EdgeTurn> turns;
    for (const Ring& edge : edges_of(frame, softened_coverage(frame, coverage))) {
        Ring p = resampled_ring(edge);
        const std::size_t n = p.size();
        if (n < 8) continue;
        for (int pass = 0; pass < kPasses; ++pass) {
            const Ring old = p;
            for (std::size_t i = 0; i < n; ++i)
                p[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
        }
        std::vector<double> curvature(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 &a = p[(i + n - 1) % n], &b = p[(i + 1) % n];
            const Vec2 d = 0.5 * (b - a), dd = b - 2.0 * p[i] + a;
            const double speed = std::max(glm::length(d), 1e-9);
            curvature[i] = (d.x * dd.y - d.y * dd.x) / (speed * speed * speed);
        }
        for (std::size_t i = 0; i < n; ++i) {
            const double side = curvature[i] > 0 ? 1 : -1, own = side * curvature[i];
            if (own > least && own >= side * curvature[(i + n - 1) % n] && own > side * curvature[(i + 1) % n])
                turns.push_back({p[i], curvature[i]});
        }
    }
    return turns;
}

std::vector<EdgeTurn> knuckles_of(const Cells& frame, std::span<const float> ink, std::span<const EdgeTurn> wanted) {
    std::vector<EdgeTurn> turns = edge_turns(frame, ink, kKnuckle);
    std::erase_if(turns, [&](const EdgeTurn& turn) {
        return std::any_of(wanted.begin(), wanted.end(), [&](const EdgeTurn& w) {
            return glm::distance(w.at, turn.at) < kNear && w.curvature / turn.curvature > kAlike;
        });
    });
    return turns;
}

}  // namespace tuft::writer
