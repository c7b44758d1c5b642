#include "decal/level_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/segment.h"

namespace tuft::decal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kNear = 4;  // cells

/// The border of a region, cell by cell.
class Border {
  public:
    Border(const Grid& grid, const LevelSet& set) : grid_(grid), set_(set) {}

    float value(int x, int y) const {
        const float v = set_.value[grid_.index(x, y)];
        const bool rim = x <= 0 || y <= 0 || x >= grid_.width - 1 || y >= grid_.height - 1;
        return rim ? std::min(v, -1e-9f) : v;
    }
    bool is_inside(int x, int y) const { return value(x, y) > 0; }

    /// Where the border crosses an edge, in cells from node (0, 0).
    Vec2 point(std::size_t edge) const {
        const std::size_t i = edge / 2;
        const int x = static_cast<int>(i % static_cast<std::size_t>(grid_.width));
        const int y = static_cast<int>(i / static_cast<std::size_t>(grid_.width));
        double s = 0.5;
        if (const auto it = set_.crossing.find(edge); it != set_.crossing.end()) {
            s = it->second;
        } else {
            const double a = value(x, y), b = edge % 2 ? value(x, y + 1) : value(x + 1, y);
            if (std::isfinite(a) && std::isfinite(b)) s = a / (a - b);
        }
        return edge % 2 ? Vec2(x, y + s) : Vec2(x + s, y);
    }

    /// Calls `use(from, to)` for each segment: edges of the grid at its ends, the inside on its left.
    template <class Use>
    void each_segment(Use&& use) const {
        for (int y = 0; y + 1 < grid_.height; ++y)
            for (int x = 0; x + 1 < grid_.width; ++x) {
                const bool in[4] = {is_inside(x, y), is_inside(x + 1, y), is_inside(x + 1, y + 1), is_inside(x, y + 1)};
                if (in[0] == in[1] && in[1] == in[2] && in[2] == in[3]) continue;
                const std::size_t edge[4] = {grid_.edge_right(x, y), grid_.edge_up(x + 1, y),
                                             grid_.edge_right(x, y + 1), grid_.edge_up(x, y)};
                // Counter-clockwise round the cell, side k goes from corner k to k + 1. The line comes in where it
                // leaves the inside and goes to the next side where the cell's rim enters it again, so corners are cut
                // off alone.
                for (int k = 0; k < 4; ++k) {
                    if (!(in[k] && !in[(k + 1) % 4])) continue;
                    int m = k;  // back to where this run of inside corners began
                    while (in[m]) m = (m + 3) % 4;
                    use(edge[k], edge[m]);
                }
            }
    }

  private:
    const Grid& grid_;
    const LevelSet& set_;
};

/// Buffers of a line of nodes.
struct LineBuffers {
    std::vector<double> f, out, z;
    std::vector<int> v;

    explicit LineBuffers(std::size_t longest) : f(longest), out(longest), z(longest + 1), v(longest + 1) {}
};

/// Lower envelope of the parabolas (q − p)² + f(p) along n nodes.
void transform_line(LineBuffers& line, int n) {
    const std::vector<double>& f = line.f;
    std::vector<double>& z = line.z;
    int k = -1;
    for (int q = 0; q < n; ++q) {
        if (std::isinf(f[static_cast<std::size_t>(q)])) continue;
        double s = -kInfinite;
        while (k >= 0) {
            const int p = line.v[static_cast<std::size_t>(k)];
            s = ((f[static_cast<std::size_t>(q)] + double{1} * q * q) -
                 (f[static_cast<std::size_t>(p)] + double{1} * p * p)) /
                (2.0 * (q - p));
            if (s > z[static_cast<std::size_t>(k)]) break;
            --k;
        }
        ++k;
        line.v[static_cast<std::size_t>(k)] = q;
        z[static_cast<std::size_t>(k)] = k == 0 ? -kInfinite : s;
    }
    if (k < 0) {
        std::fill_n(line.out.begin(), n, kInfinite);
        return;
    }
    int j = 0;
    for (int q = 0; q < n; ++q) {
        while (j < k && z[static_cast<std::size_t>(j) + 1] < q) ++j;
        const int p = line.v[static_cast<std::size_t>(j)];
        line.out[static_cast<std::size_t>(q)] = double{1} * (q - p) * (q - p) + f[static_cast<std::size_t>(p)];
    }
}

/// Lowers `square` to the squared distances, in cells, to the points where the border crosses edges upwards, or those
/// to the right. Such points lie on lines of the grid: along these lines the distance is that to the next point either
/// way, across them the envelope of parabolas.
void lower_to_crossings(const Grid& grid, const Border& border, bool upwards, std::vector<double>& square) {
    const int n_lines = upwards ? grid.width : grid.height, n = upwards ? grid.height : grid.width;
    const auto at = [&](int line, int i) { return upwards ? grid.index(line, i) : grid.index(i, line); };
    const auto inside = [&](int line, int i) {
        return upwards ? border.is_inside(line, i) : border.is_inside(i, line);
    };
    std::vector<double> along(grid.size(), kInfinite);
    std::vector<double> points;
    for (int line = 0; line < n_lines; ++line) {
        points.clear();
        for (int i = 0; i + 1 < n; ++i)
            if (inside(line, i) != inside(line, i + 1)) {
                const Vec2 p = border.point(2 * at(line, i) + (upwards ? 1 : 0));
                points.push_back(upwards ? p.y : p.x);
            }
        std::size_t next = 0;
        for (int i = 0; i < n && !points.empty(); ++i) {
            while (next < points.size() && points[next] < i) ++next;
            double d = kInfinite;
            if (next < points.size()) d = points[next] - i;
            if (next > 0) d = std::min(d, i - points[next - 1]);
            along[at(line, i)] = d * d;
        }
    }
    LineBuffers buffers(static_cast<std::size_t>(n_lines));
    for (int i = 0; i < n; ++i) {
        for (int line = 0; line < n_lines; ++line) buffers.f[static_cast<std::size_t>(line)] = along[at(line, i)];
        transform_line(buffers, n_lines);
        for (int line = 0; line < n_lines; ++line) {
            double& s = square[at(line, i)];
            s = std::min(s, buffers.out[static_cast<std::size_t>(line)]);
        }
    }
}

}  // namespace

std::vector<float> signed_distance(const Grid& grid, const LevelSet& set) {
    const Border border(grid, set);
    std::vector<double> square(grid.size(), kInfinite);
    for (const bool upwards : {true, false}) lower_to_crossings(grid, border, upwards, square);
    border.each_segment([&](std::size_t from, std::size_t to) {
        const Vec2 a = border.point(from), b = border.point(to);
        const auto lo = glm::ivec2(glm::floor(glm::min(a, b))) - kNear,
                   hi = glm::ivec2(glm::ceil(glm::max(a, b))) + kNear;
        for (int y = std::max(0, lo.y); y <= std::min(grid.height - 1, hi.y); ++y)
            for (int x = std::max(0, lo.x); x <= std::min(grid.width - 1, hi.x); ++x) {
                const double d = segment_distance(a, b, Vec2(x, y));
                double& s = square[grid.index(x, y)];
                s = std::min(s, d * d);
            }
    });
    std::vector<float> distance(grid.size());
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            const double d = grid.cell * std::sqrt(square[grid.index(x, y)]);
            distance[grid.index(x, y)] = static_cast<float>(border.is_inside(x, y) ? d : -d);
        }
    return distance;
}

Region zero_lines(const Grid& grid, const LevelSet& set) {
    const Border border(grid, set);
    std::unordered_map<std::size_t, std::size_t> next;
    std::vector<std::size_t> starts;
    border.each_segment([&](std::size_t from, std::size_t to) {
        next[from] = to;
        starts.push_back(from);
    });
    std::sort(starts.begin(), starts.end());
    Region region;
    for (const std::size_t start : starts) {
        Ring ring;
        std::size_t edge = start;
        for (auto it = next.find(edge); it != next.end(); it = next.find(edge)) {
            const Vec2 p = border.point(edge);
            ring.push_back(grid.node(p.x, p.y));
            edge = it->second;
            next.erase(it);
        }
        if (ring.size() > 2) region.push_back(std::move(ring));
    }
    return region;
}

}  // namespace tuft::decal
