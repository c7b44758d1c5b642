#include "brush/tuft/shape/lattice.h"

#include <algorithm>

#include "core/cubic.h"

namespace tuft::brush {

namespace {

/// A section over the broad side: F(x, y) = base + y across.
struct Row {
    Vec3 base{0}, across{0};
};

Row row_at(const LatticeInput& in, std::size_t node, double x) {
    const std::size_t last = in.spine_x.size() - 1;
    std::size_t k = 0;
    while (k + 1 < last && x > in.spine_x[k + 1]) ++k;
    const auto of = [&](std::size_t s) {
        const LatticeFrame& f = in.frames[s][node];
        return Row{f.centre + (x - in.spine_x[s]) * f.x, f.y};
    };
    if (last == 0) return of(0);
    const double part = std::clamp((x - in.spine_x[k]) / (in.spine_x[k + 1] - in.spine_x[k]), 0.0, 1.0);
    const Row a = of(k), b = of(k + 1);
    return {glm::mix(a.base, b.base, part), glm::mix(a.across, b.across, part)};
}

/// Control values of the cubic through four values at 0, 1/3, 2/3, 1.
template <class T>
std::array<T, 4> control_of(const std::array<T, 4>& f) {
    return {f[0], (-5.0 * f[0] + 18.0 * f[1] - 9.0 * f[2] + 2.0 * f[3]) / 6.0,
            (2.0 * f[0] - 9.0 * f[1] + 18.0 * f[2] - 5.0 * f[3]) / 6.0, f[3]};
}

using Layer = std::array<std::array<Vec3, 4>, 4>;  // [i][j]

Layer layer_at(const LatticeInput& in, std::size_t node) {
    std::array<Vec3, 4> base, across;
    for (std::size_t i = 0; i < 4; ++i) {
        const Row row = row_at(in, node, in.lo.x + (in.hi.x - in.lo.x) * static_cast<double>(i) / 3);
        base[i] = row.base;
        across[i] = row.across;
    }
    base = control_of(base);
    across = control_of(across);
    Layer out;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            out[i][j] = base[i] + (in.lo.y + (in.hi.y - in.lo.y) * static_cast<double>(j) / 3) * across[i];
    return out;
}

}  // namespace

SpineLattice::SpineLattice(const LatticeInput& in) {
    const std::size_t n = in.at.size();
    std::vector<Layer> layers;
    for (std::size_t k = 0; k < n; ++k) layers.push_back(layer_at(in, k));
    const auto rate = [&](std::size_t k, std::size_t i, std::size_t j) {
        return (layers[k + 1][i][j] - layers[k][i][j]) / (in.at[k + 1] - in.at[k]);
    };
    // Slope of the parabola through a node and its neighbours.
    const auto slope = [&](std::size_t k, std::size_t i, std::size_t j) {
        if (k == 0) return rate(0, i, j);
        if (k == n - 1) return rate(n - 2, i, j);
        const double before = in.at[k] - in.at[k - 1], after = in.at[k + 1] - in.at[k];
        return (after * rate(k - 1, i, j) + before * rate(k, i, j)) / (before + after);
    };
    cells_.resize(n - 1);
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const double third = (in.at[k + 1] - in.at[k]) / 3;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                cells_[k][i][j] = {layers[k][i][j], layers[k][i][j] + third * slope(k, i, j),
                                   layers[k + 1][i][j] - third * slope(k + 1, i, j), layers[k + 1][i][j]};
    }
}

Vec3 SpineLattice::at(const LatticePlace& place) const {
    const Cell& cell = cells_[place.cell];
    const auto bs = bernstein(place.stu.x), bt = bernstein(place.stu.y), bu = bernstein(place.stu.z);
    Vec3 sum{0};
    for (std::size_t i = 0; i < 4; ++i) {
        Vec3 over_t{0};
        for (std::size_t j = 0; j < 4; ++j) {
            const auto& p = cell[i][j];
            over_t += bt[j] * (bu[0] * p[0] + bu[1] * p[1] + bu[2] * p[2] + bu[3] * p[3]);
        }
        sum += bs[i] * over_t;
    }
    return sum;
}

LatticePlace lattice_place(std::span<const double> at, const Vec2& lo, const Vec2& hi, const Vec2& point,
                           double along) {
    const auto after = std::upper_bound(at.begin() + 1, at.end() - 1, along);
    const auto k = static_cast<std::size_t>(after - at.begin()) - 1;
    const Vec2 st = (point - lo) / (hi - lo);
    return {static_cast<std::uint32_t>(k), {st.x, st.y, (along - at[k]) / (at[k + 1] - at[k])}};
}

}  // namespace tuft::brush
