#include "decal/paint_field.h"

#include <algorithm>
#include <cmath>

namespace tuft::decal {
namespace {

constexpr double kPainted = 0.5;      // coverage
constexpr int kMostSamples = 5;       // along a side of a cell
constexpr int kBisections = 6;        // to 1/64 of a cell
constexpr float kThin = 1e-3f;        // value of nodes between which and the next ones a line of paint passes
constexpr double kLeastPart = 0.02;   // of an edge
constexpr double kFarOutside = -1e3;  // weight in a triangle without area

/// A face of the surface in cells of the grid.
struct FlatFace {
    Vec2 corner{0}, x{0}, y{0};
    double det = 0;

    FlatFace(const PrintSurface& surface, const Grid& grid, std::size_t t) {
        const auto& f = surface.faces[t];
        corner = (surface.flat[f[0]] - grid.origin) / grid.cell;
        x = (surface.flat[f[1]] - grid.origin) / grid.cell - corner;
        y = (surface.flat[f[2]] - grid.origin) / grid.cell - corner;
        det = x.x * y.y - x.y * y.x;
    }
    Weights at(const Vec2& p) const {
        const Vec2 d = p - corner;
        const double b = (d.x * y.y - d.y * y.x) / det, c = (x.x * d.y - x.y * d.x) / det;
        return {1 - b - c, b, c};
    }
};

Weights in_model(const std::array<Weights, 3>& corners, const Weights& w) {
    Weights out{};
    for (std::size_t m = 0; m < 3; ++m) out[m] = w[0] * corners[0][m] + w[1] * corners[1][m] + w[2] * corners[2][m];
    return out;
}

/// First and last painted sample of a cell along both axes, packed.
struct Extent {
    int lo[2], hi[2];

    static std::uint16_t packed(int i, int j) { return static_cast<std::uint16_t>(i | i << 3 | j << 6 | j << 9); }
    explicit Extent(std::uint16_t p) : lo{p & 7, p >> 6 & 7}, hi{p >> 3 & 7, p >> 9 & 7} {}
    std::uint16_t with(int i, int j) const {
        return static_cast<std::uint16_t>(std::min(lo[0], i) | std::max(hi[0], i) << 3 | std::min(lo[1], j) << 6 |
                                          std::max(hi[1], j) << 9);
    }
};

class PaintFinder {
  public:
    PaintFinder(const PrintSurface& surface, const CoverageFn& coverage, const Grid& grid, double texel)
        : surface_(surface),
          coverage_(coverage),
          grid_(grid),
          fine_(std::clamp(static_cast<int>(std::ceil(grid.cell / texel)), 1, kMostSamples)),
          face_(grid.size(), kNone),
          own_(grid.size(), -1),
          extent_(grid.size(), 0) {
        field_.painted.value.assign(grid.size(), static_cast<float>(-kPainted));
        field_.mean.assign(grid.size(), 0);
    }

    PaintField find() {
        for (std::size_t t = 0; t < surface_.faces.size(); ++t) sample(t);
        for (std::size_t i = 0; i < own_.size(); ++i)
            if (own_[i] >= 0) field_.painted.value[i] = own_[i] - static_cast<float>(kPainted);
        for (int y = 1; y + 1 < grid_.height; ++y)
            for (int x = 1; x + 1 < grid_.width; ++x)
                if (is_thin(x, y)) field_.painted.value[grid_.index(x, y)] = kThin;
        for (const float value : field_.painted.value) field_.any = field_.any || value > 0;
        find_rim();
        find_crossings();
        return std::move(field_);
    }

  private:
    /// Takes samples about the nodes that lie in a face, and on the nodes.
    void sample(std::size_t t) {
        const FlatFace face(surface_, grid_, t);
        if (!(face.det > 0)) return;
        const Vec2 a = face.corner, b = a + face.x, c = a + face.y;
        const Vec2 lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
        const double step = 1.0 / fine_, first = 0.5 * step - 0.5;
        const auto value_at = [&](const Vec2& p) {
            const Weights w = face.at(p);
            if (w[1] < 0 || w[2] < 0 || w[1] + w[2] >= 1) return -1.0;
            return printed_at(surface_, coverage_, t, grid_.node(p.x, p.y), in_model(surface_.weights[t], w)).coverage;
        };
        const int top = std::min(grid_.height - 1, static_cast<int>(std::ceil(hi.y)));
        const int right = std::min(grid_.width - 1, static_cast<int>(std::ceil(hi.x)));
        for (int y = std::max(0, static_cast<int>(std::floor(lo.y))); y <= top; ++y)
            for (int x = std::max(0, static_cast<int>(std::floor(lo.x))); x <= right; ++x) {
                const std::size_t at = grid_.index(x, y);
                double middle = fine_ % 2 ? -1 : value_at(Vec2(x, y));
                for (int j = 0; j < fine_; ++j)
                    for (int i = 0; i < fine_; ++i) {
                        const double value = value_at(Vec2(x + first + step * i, y + first + step * j));
                        if (value < 0) continue;
                        if (t < surface_.n_own) field_.mean[at] += static_cast<float>(value / (fine_ * fine_));
                        if (2 * i + 1 == fine_ && 2 * j + 1 == fine_) middle = value;
                        if (!(value > kPainted)) continue;
                        // Counted from 1, so that 0 says that nothing is painted.
                        extent_[at] =
                            extent_[at] ? Extent(extent_[at]).with(i + 1, j + 1) : Extent::packed(i + 1, j + 1);
                    }
                if (middle < 0 || face_[at] != kNone) continue;
                face_[at] = static_cast<std::uint32_t>(t);
                own_[at] = static_cast<float>(middle);
            }
    }

    /// Whether paint lies in the cell of a node, but neither on it nor on those next to it.
    bool is_thin(int x, int y) const {
        if (extent_[grid_.index(x, y)] == 0) return false;
        for (const std::size_t i : {grid_.index(x, y), grid_.index(x - 1, y), grid_.index(x + 1, y),
                                    grid_.index(x, y - 1), grid_.index(x, y + 1)})
            if (own_[i] > kPainted) return false;
        return true;
    }

    /// Finds where the rim of the surface crosses edges of the grid.
    void find_rim() {
        std::unordered_map<std::uint64_t, int> uses;
        const auto key = [](std::uint32_t a, std::uint32_t b) {
            return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
        };
        for (const auto& f : surface_.faces)
            for (std::size_t k = 0; k < 3; ++k) ++uses[key(f[k], f[(k + 1) % 3])];
        for (const auto& f : surface_.faces)
            for (std::size_t k = 0; k < 3; ++k)
                if (uses[key(f[k], f[(k + 1) % 3])] == 1)
                    cross((surface_.flat[f[k]] - grid_.origin) / grid_.cell,
                          (surface_.flat[f[(k + 1) % 3]] - grid_.origin) / grid_.cell);
    }

    /// Notes where a segment, in cells, crosses edges of the grid.
    void cross(const Vec2& a, const Vec2& b) {
        for (const int axis : {0, 1}) {
            const int other = 1 - axis;
            if (a[axis] == b[axis]) continue;
            const double lo = std::min(a[axis], b[axis]), hi = std::max(a[axis], b[axis]);
            const int last = (axis == 0 ? grid_.width : grid_.height) - 1;
            const int across = (axis == 0 ? grid_.height : grid_.width) - 1;
            for (int k = std::max(0, static_cast<int>(std::ceil(lo))); k <= hi && k <= last; ++k) {
                const double q = a[other] + (k - a[axis]) / (b[axis] - a[axis]) * (b[other] - a[other]);
                const int cell = static_cast<int>(std::floor(q));
                if (cell < 0 || cell >= across) continue;
                // On a line of x the edge goes up, on a line of y to the right.
                rim_[axis == 0 ? grid_.edge_up(k, cell) : grid_.edge_right(cell, k)] = static_cast<float>(q - cell);
            }
        }
    }

    void find_crossings() {
        const auto inside = [&](int x, int y) { return field_.painted.value[grid_.index(x, y)] > 0; };
        for (int y = 0; y + 1 < grid_.height; ++y)
            for (int x = 0; x + 1 < grid_.width; ++x) {
                const bool here = inside(x, y);
                if (here != inside(x + 1, y))
                    field_.painted.crossing[grid_.edge_right(x, y)] = crossing({x, y}, 0, here);
                if (here != inside(x, y + 1)) field_.painted.crossing[grid_.edge_up(x, y)] = crossing({x, y}, 1, here);
            }
    }

    /// The part of the edge from a node along an axis at which the paint ends.
    float crossing(const glm::ivec2& node, int axis, bool node_is_inside) const {
        glm::ivec2 in = node, out = node;
        (node_is_inside ? out : in)[axis] += 1;
        const std::size_t from = grid_.index(in.x, in.y), to = grid_.index(out.x, out.y);
        const int side = node_is_inside ? 1 : -1;
        double part;
        if (own_[from] > kPainted) {
            double lo = 0, hi = 1;
            for (int k = 0; k < kBisections; ++k) {
                const double middle = 0.5 * (lo + hi);
                (is_painted(Vec2(in) + middle * Vec2(out - in), from, to) ? lo : hi) = middle;
            }
            part = 0.5 * (lo + hi);
        } else {
            const Extent extent(extent_[from]);
            const double last = side > 0 ? extent.hi[axis] : fine_ + 1 - extent.lo[axis];
            part = last / fine_ - 0.5;
        }
        if (face_[to] == kNone)
            if (const auto it = rim_.find(2 * grid_.index(node.x, node.y) + static_cast<std::size_t>(axis));
                it != rim_.end())
                part = std::min(part, node_is_inside ? double{it->second} : 1.0 - it->second);
        part = std::clamp(part, kLeastPart, 1 - kLeastPart);
        return static_cast<float>(node_is_inside ? part : 1 - part);
    }

    /// Whether there is paint at a point between two nodes, in the face of that one in which the point lies deeper.
    bool is_painted(const Vec2& p, std::size_t from, std::size_t to) const {
        std::uint32_t best = kNone;
        Weights weights{};
        double deepest = kFarOutside;
        for (const std::size_t node : {from, to}) {
            if (face_[node] == kNone || face_[node] == best) continue;
            const Weights w = FlatFace(surface_, grid_, face_[node]).at(p);
            if (const double least = std::min({w[0], w[1], w[2]}); least > deepest)
                deepest = least, best = face_[node], weights = w;
        }
        return best != kNone &&
               printed_at(surface_, coverage_, best, grid_.node(p.x, p.y), in_model(surface_.weights[best], weights))
                       .coverage > kPainted;
    }

    const PrintSurface& surface_;
    const CoverageFn& coverage_;
    const Grid& grid_;
    int fine_;
    PaintField field_;
    std::vector<std::uint32_t> face_;    // under each node
    std::vector<float> own_;             // coverage at each node; −1: no face
    std::vector<std::uint16_t> extent_;  // of the painted samples of each cell; 0: none
    std::unordered_map<std::size_t, float> rim_;
};

}  // namespace

PaintField find_paint(const PrintSurface& surface, const CoverageFn& coverage, const Grid& grid, double texel) {
    return PaintFinder(surface, coverage, grid, texel).find();
}

double paint_inside(const Grid& grid, const std::vector<float>& coverage, const Region& region) {
    const Box2 box = box_of(region);
    const int first = std::max(0, static_cast<int>((box.lo.y - grid.origin.y) / grid.cell));
    const int last = std::min(grid.height - 1, static_cast<int>((box.hi.y - grid.origin.y) / grid.cell) + 1);
    std::vector<std::vector<std::pair<double, int>>> crossings(static_cast<std::size_t>(std::max(0, last - first + 1)));
    for (const Ring& ring : region)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = (ring[i] - grid.origin) / grid.cell,
                       b = (ring[(i + 1) % ring.size()] - grid.origin) / grid.cell;
            const double lo = std::min(a.y, b.y), hi = std::max(a.y, b.y);
            for (int y = std::max(first, static_cast<int>(std::ceil(lo))); y < hi && y <= last; ++y)
                crossings[static_cast<std::size_t>(y - first)].emplace_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x),
                                                                            b.y > a.y ? -1 : 1);
        }
    double sum = 0;
    for (int y = first; y <= last; ++y) {
        auto& row = crossings[static_cast<std::size_t>(y - first)];
        std::sort(row.begin(), row.end());
        int winding = 0;
        for (std::size_t k = 0; k + 1 < row.size(); ++k) {
            winding += row[k].second;
            if (winding <= 0) continue;
            const int to = std::min(grid.width, static_cast<int>(std::ceil(row[k + 1].first)));
            for (int x = std::max(0, static_cast<int>(std::ceil(row[k].first))); x < to; ++x)
                sum += coverage[grid.index(x, y)];
        }
    }
    return sum * grid.cell * grid.cell;
}

}  // namespace tuft::decal
