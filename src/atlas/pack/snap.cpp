#include "atlas/pack/snap.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "atlas/pack/raster.h"

namespace tuft::atlas {
namespace {

using GridPoint = std::array<std::int64_t, 2>;

constexpr double kLeastArea = 0.45;   // of what a triangle has before it is rounded: more than a third, stretch below 3
constexpr double kLeastHeight = 1.0;  // grid steps: a corner that rounding shifts by a step shears it by 1 at most

constexpr int kSweeps = 16;              // for positive areas
constexpr int kShortSweeps = 4;          // for the sake of stretch
constexpr std::int64_t kShortReach = 4;  // grid steps: rounding shifted corners by less than one
constexpr std::int64_t kFlipped = std::int64_t{1} << 60;

/// Twice the areas, in squared steps of the grid, that triangles shall have at least.
std::vector<std::int64_t> least_areas(const std::vector<std::array<std::uint32_t, 3>>& faces,
                                      const std::vector<Vec2>& uv) {
    std::vector<std::int64_t> least(faces.size());
    for (std::size_t t = 0; t < least.size(); ++t) {
        const Vec2 a = double(kUvGrid) * (uv[faces[t][1]] - uv[faces[t][0]]);
        const Vec2 b = double(kUvGrid) * (uv[faces[t][2]] - uv[faces[t][0]]);
        const double longest = std::sqrt(std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(b - a, b - a)}));
        const double twice = std::max(kLeastArea * (a.x * b.y - a.y * b.x), kLeastHeight * longest);
        least[t] = static_cast<std::int64_t>(std::clamp(std::ceil(twice), 1.0, 1e15));
    }
    return least;
}

class Snapper {
  public:
    Snapper(const std::vector<std::array<std::uint32_t, 3>>& faces, std::vector<GridPoint>& p)
        : faces_(faces), p_(p), start_(p.size() + 1, 0), around_(3 * faces.size()) {
        for (const auto& f : faces)
            for (const std::uint32_t v : f) ++start_[v + 1];
        for (std::size_t v = 0; v < p.size(); ++v) start_[v + 1] += start_[v];
        std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
        for (std::uint32_t t = 0; t < faces.size(); ++t)
            for (const std::uint32_t v : faces[t]) around_[fill[v]++] = t;
    }

    /// Sets the least area of each triangle.
    void require(std::span<const std::int64_t> least) { least_ = least; }

    std::int64_t area(std::uint32_t t) const {
        const auto& f = faces_[t];
        return twice_area(p_[f[0]], p_[f[1]], p_[f[2]]);
    }

    /// Negative where the area is too small, and far less where it is not positive.
    std::int64_t excess(std::uint32_t t) const {
        const std::int64_t own = area(t);
        return own > 0 ? own - least_[t] : own - kFlipped;
    }

    /// Triangles whose area is too small.
    std::vector<std::uint32_t> bad() const {
        std::vector<std::uint32_t> bad;
        for (std::uint32_t t = 0; t < faces_.size(); ++t)
            if (excess(t) < 0) bad.push_back(t);
        return bad;
    }

    /// Moves the corners of triangles whose area is too small.
    void enlarge(std::int64_t reach, int sweeps) {
        const std::vector<std::uint32_t> small = bad();
        bool moved = !small.empty();
        for (int sweep = 0; sweep < sweeps && moved; ++sweep) {
            moved = false;
            for (const std::uint32_t t : small)
                for (int k = 0; k < 3 && excess(t) < 0; ++k) moved |= move(faces_[t][k], reach);
        }
    }

    std::int64_t worst(std::uint32_t v) const {
        std::int64_t least = excess(around_[start_[v]]);
        for (std::uint32_t i = start_[v] + 1; i < start_[v + 1]; ++i) least = std::min(least, excess(around_[i]));
        return least;
    }

    /// Moves v to the nearest ring of grid points where its triangles are all large enough,
    /// or else where the worst of them is best; true when it moved.
    bool move(std::uint32_t v, std::int64_t reach) {
        const GridPoint here = p_[v];
        std::int64_t best = worst(v);
        GridPoint better = here;
        for (std::int64_t r = 1; r <= reach && best < 0; r *= 2)
            for (int k = 0; k < 16; ++k) {
                constexpr std::int64_t kDx[] = {4, 4, 4, 2, 0, -2, -4, -4, -4, -4, -4, -2, 0, 2, 4, 4};
                constexpr std::int64_t kDy[] = {0, 2, 4, 4, 4, 4, 4, 2, 0, -2, -4, -4, -4, -4, -4, -2};
                const auto step = [r](std::int64_t d) { return d >= 0 ? (d * r + 3) / 4 : -((-d * r + 3) / 4); };
                p_[v] = {here[0] + step(kDx[k]), here[1] + step(kDy[k])};
                if (p_[v][0] < 0 || p_[v][1] < 0 || p_[v][0] > std::int64_t(kUvGrid) ||
                    p_[v][1] > std::int64_t(kUvGrid))
                    continue;
                const std::int64_t w = worst(v);
                if (w > best) {
                    best = w;
                    better = p_[v];
                }
            }
        p_[v] = better;
        return better != here;
    }

  private:
    const std::vector<std::array<std::uint32_t, 3>>& faces_;
    std::span<const std::int64_t> least_;
    std::vector<GridPoint>& p_;
    std::vector<std::uint32_t> start_, around_;
};

}  // namespace

std::vector<std::uint32_t> snap_to_floats(const std::vector<std::array<std::uint32_t, 3>>& faces, std::vector<Vec2>& uv,
                                          std::uint32_t size) {
    std::vector<GridPoint> p(uv.size());
    for (std::size_t v = 0; v < uv.size(); ++v)
        for (int k = 0; k < 2; ++k) p[v][k] = std::llround(std::clamp(uv[v][k], 0.0, 1.0) * kUvGrid);
    const std::vector<std::int64_t> least = least_areas(faces, uv), positive(faces.size(), 1);
    Snapper snapper(faces, p);
    snapper.require(positive);
    snapper.enlarge(static_cast<std::int64_t>(kUvGrid / (16.0 * std::max(size, 1u))), kSweeps);
    std::vector<std::uint32_t> bad = snapper.bad();
    snapper.require(least);
    snapper.enlarge(kShortReach, kShortSweeps);
    for (std::size_t v = 0; v < uv.size(); ++v)
        uv[v] = {static_cast<double>(p[v][0]) / kUvGrid, static_cast<double>(p[v][1]) / kUvGrid};
    return bad;
}

}  // namespace tuft::atlas
