#include "stroke/surface/even_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/interrupt.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kPiecesTogether = 32;  // of a line, in one box
constexpr double kLeastScale = 0.3;          // of lengths by the map; less is a fold, not a surface
constexpr double kMostScale = 3;             // likewise
constexpr double kMostPiecesOfEdge = 1e5;    // of one edge of a ring

Vec2 quarter_turn(const Vec2& v) {
    return {-v.y, v.x};
}

Vec2 nearest_on(const Vec2& a, const Vec2& b, const Vec2& p) {
    const Vec2 run = b - a;
    const double square = glm::dot(run, run);
    return square > 0 ? a + std::clamp(glm::dot(p - a, run) / square, 0.0, 1.0) * run : a;
}

/// The middles of an area's lines, for nearest points.
class Middles {
  public:
    explicit Middles(const std::vector<std::vector<Vec2>>& lines) {
        for (const auto& line : lines)
            for (std::size_t i = 0; i < line.size(); ++i)
                if (i + 1 < line.size() || i == 0) pieces_.push_back({line[i], line[std::min(i + 1, line.size() - 1)]});
        for (std::size_t begin = 0; begin < pieces_.size(); begin += kPiecesTogether) {
            Run run{begin, std::min(begin + kPiecesTogether, pieces_.size()), Vec2(HUGE_VAL), Vec2(-HUGE_VAL)};
            for (std::size_t i = begin; i < run.end; ++i)
                for (const Vec2& p : {pieces_[i].from, pieces_[i].to})
                    run.low = glm::min(run.low, p), run.high = glm::max(run.high, p);
            runs_.push_back(run);
        }
    }

    bool empty() const { return pieces_.empty(); }

    Vec2 nearest(const Vec2& p) const {
        double best = std::numeric_limits<double>::infinity();
        Vec2 at = p;
        for (const Run& run : runs_) {
            if (glm::length(glm::max(glm::max(run.low - p, p - run.high), Vec2(0))) >= best) continue;
            for (std::size_t i = run.begin; i < run.end; ++i) {
                const Vec2 foot = nearest_on(pieces_[i].from, pieces_[i].to, p);
                if (const double d = glm::distance(foot, p); d < best) best = d, at = foot;
            }
        }
        return at;
    }

  private:
    struct Piece {
        Vec2 from, to;
    };
    struct Run {
        std::size_t begin, end;
        Vec2 low, high;
    };
    std::vector<Piece> pieces_;
    std::vector<Run> runs_;
};

/// Metres on the surface per metre of the drawing, as a vector.
std::optional<Vec3> rate(const SurfaceLattice& lattice, const Vec2& at, const Vec2& direction) {
    const double h = std::max(lattice.step.x, lattice.step.y);
    const auto before = lattice(at - h * direction), after = lattice(at + h * direction);
    if (!before || !after) return {};
    return (*after - *before) / (2 * h);
}

/// The direction across `offset` turned by 90° on the surface, unit in the drawing.
std::optional<Vec2> direction_of(const SurfaceLattice& lattice, const Vec2& at, const Vec2& offset) {
    const auto x = rate(lattice, at, {1, 0}), y = rate(lattice, at, {0, 1});
    if (!x || !y) return {};
    const Vec2 along = quarter_turn(offset);
    const Vec3 line = along.x * *x + along.y * *y;
    const Vec2 across = -quarter_turn({glm::dot(*x, line), glm::dot(*y, line)});
    const double length = glm::length(across);
    if (!(length > 0) || !(glm::dot(across, offset) > 0)) return {};
    return across / length;
}

Vec2 even_point(const SurfaceLattice& lattice, const Middles& middles, const Vec2& p) {
    const Vec2 foot = middles.nearest(p);
    double left = glm::distance(p, foot);
    if (!(left > 0)) return p;
    const auto direction = direction_of(lattice, foot, (p - foot) / left);
    if (!direction) return p;
    const double stride = std::min(lattice.step.x, lattice.step.y);
    double along = 0;
    for (double scale = 1; left > 0;) {
        const double piece = std::min(stride, left / scale);
        if (const auto v = rate(lattice, foot + (along + 0.5 * piece) * *direction, *direction))
            scale = std::clamp(glm::length(*v), kLeastScale, kMostScale);
        const double part = std::min(piece, left / scale);
        along += part;
        left -= part * scale;
        if (left < 1e-9 * stride) break;
    }
    return foot + along * *direction;
}

}  // namespace

std::optional<Vec3> SurfaceLattice::operator()(const Vec2& flat) const {
    const Vec2 cell = (flat - low) / step;
    if (!(cell.x >= 0 && cell.y >= 0 && cell.x <= width - 1 && cell.y <= height - 1)) return {};
    const int i = std::min(static_cast<int>(cell.x), width - 2), j = std::min(static_cast<int>(cell.y), height - 2);
    const auto k = static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
    const std::size_t below = k + static_cast<std::size_t>(width);
    if (!on_surface[k] || !on_surface[k + 1] || !on_surface[below] || !on_surface[below + 1]) return {};
    const double u = cell.x - i, v = cell.y - j;
    return glm::mix(glm::mix(at[k], at[k + 1], u), glm::mix(at[below], at[below + 1], u), v);
}

std::vector<std::vector<Vec2>> even_rings(const FlatArea& area, const SurfaceLattice& lattice) {
    const Middles middles(area.lines);
    if (middles.empty()) return area.rings;
    const double longest = std::min(lattice.step.x, lattice.step.y);
    std::vector<std::vector<Vec2>> rings;
    for (const auto& ring : area.rings) {
        check_interrupt();
        std::vector<Vec2>& out = rings.emplace_back();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
            const auto n =
                static_cast<int>(std::clamp(std::ceil(glm::distance(a, b) / longest), 1.0, kMostPiecesOfEdge));
            for (int k = 0; k < n; ++k)
                out.push_back(even_point(lattice, middles, glm::mix(a, b, static_cast<double>(k) / n)));
        }
    }
    return rings;
}

}  // namespace tuft::stroke
