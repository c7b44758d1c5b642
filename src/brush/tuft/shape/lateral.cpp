#include "brush/tuft/shape/lateral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tuft::brush {

namespace {

/// u''_i = in u_{i-1} + own u_i + out u_{i+1} with the tributary length of the node.
struct Curvature {
    double in = 0, own = 0, out = 0, weight = 0;
};

/// By second differences; at the ferrule with a mirrored neighbour (u' = 0), none at the tip.
Curvature curvature(const Recycled<double>& at, std::size_t i) {
    if (i == 0) {
        const double first = at[1] - at[0];
        return {0, -2 / (first * first), 2 / (first * first), 0.5 * first};
    }
    if (i + 1 == at.size()) return {};
    const double a = at[i] - at[i - 1], b = at[i + 1] - at[i];
    return {2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b)), 0.5 * (a + b)};
}

double tributary(const Recycled<double>& at, std::size_t i) {
    const std::size_t n = at.size() - 1;
    return 0.5 * (at[std::min(i + 1, n)] - at[i > 0 ? i - 1 : 0]);
}

/// Taper of a node over that at the root.
double taper(const LateralSprings& s, std::size_t i) {
    return s.taper.empty() ? 1 : s.taper[i] / s.taper[0];
}

/// λ² at a node.
double reach_squared(const LateralSprings& s, std::size_t i) {
    return s.reach * s.reach * taper(s, i);
}

/// 2 κ0 λ² r² / h of the slope spring between nodes i - 1 and i.
double slope_spring(const Recycled<double>& at, const LateralSprings& s, std::size_t i) {
    const double a = taper(s, i - 1), b = taper(s, i);
    return s.bend * (a * a * reach_squared(s, i - 1) + b * b * reach_squared(s, i)) / (at[i] - at[i - 1]);
}

/// κ0 λ⁴ w of the bend spring at node i.
double bend_spring(const LateralSprings& s, std::size_t i, const Curvature& c) {
    const double squared = reach_squared(s, i);
    return s.bend * squared * squared * c.weight;
}

using Band = Recycled<std::array<double, 3>>;

/// Solves in place by L D Lᵀ; the matrix is positive definite. Leaves 1/D and L in it.
void solve_band(Band& m, Recycled<double>& x) {
    const std::size_t n = m.size();
    for (std::size_t i = 0; i < n; ++i) {
        double d = m[i][0];
        if (i > 1) {
            const double raw = m[i][2];
            m[i][2] *= m[i - 2][0];
            m[i][1] -= raw * m[i - 1][1];
            d -= raw * m[i][2];
            x[i] -= m[i][2] * x[i - 2];
        }
        if (i > 0) {
            const double raw = m[i][1];
            m[i][1] *= m[i - 1][0];
            d -= raw * m[i][1];
            x[i] -= m[i][1] * x[i - 1];
        }
        m[i][0] = 1 / d;
    }
    for (std::size_t i = n; i-- > 0;) {
        x[i] *= m[i][0];
        if (i + 1 < n) x[i] -= m[i + 1][1] * x[i + 1];
        if (i + 2 < n) x[i] -= m[i + 2][2] * x[i + 2];
    }
}

}  // namespace

LateralRow lateral_row(const Recycled<double>& at, const LateralSprings& s) {
    LateralRow row;
    Band& m = row.band;
    m.assign(at.size(), {0, 0, 0});
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double r = taper(s, i), w = tributary(at, i);
        row.taper.push_back(r);
        row.weight.push_back(w);
        m[i][0] += s.stretch * w * r * r;
        if (i > 0) {
            const double slope = slope_spring(at, s, i);
            m[i - 1][0] += slope;
            m[i][0] += slope;
            m[i][1] -= slope;
        }
        if (i + 1 == at.size()) continue;
        const Curvature c = curvature(at, i);
        const double k = bend_spring(s, i, c) * r * r;
        m[i][0] += k * c.own * c.own;
        m[i + 1][0] += k * c.out * c.out;
        m[i + 1][1] += k * c.out * c.own;
        if (i == 0) continue;
        m[i - 1][0] += k * c.in * c.in;
        m[i][1] += k * c.in * c.own;
        m[i + 1][2] += k * c.in * c.out;
    }
    row.at_root = {m[1][1], m.size() > 2 ? m[2][2] : 0};
    m[0] = {1, 0, 0};
    m[1][1] = 0;
    if (m.size() > 2) m[2][2] = 0;
    row.wall = s.wall * s.stretch;
    return row;
}

Recycled<double> solve_lateral(const Recycled<double>& at, const LateralSprings& s, const LateralSide& side) {
    return solve_lateral(lateral_row(at, s), side);
}

Recycled<double> solve_lateral(const LateralRow& row, const LateralSide& side) {
    const std::size_t count = row.band.size();
    Recycled<char> held(count, 0);
    Recycled<double> u(count);
    Band m;
    for (int pass = 0; pass < kWallPasses; ++pass) {
        m = row.band;
        u[0] = side.root;
        for (std::size_t i = 1; i < count; ++i) {
            const double w = row.weight[i], r = row.taper[i];
            u[i] = w * side.push[i] * r - (i < 3 ? row.at_root[i - 1] * side.root : 0);
            if (!held[i]) continue;
            m[i][0] += row.wall * w * r * r;
            u[i] += row.wall * w * side.clear[i] * r;
        }
        solve_band(m, u);
        bool same = true;
        for (std::size_t i = 1; i < count; ++i) {
            u[i] *= row.taper[i];
            const char now = u[i] > side.clear[i];
            same = same && now == held[i];
            held[i] = now;
        }
        if (same) break;
    }
    return u;
}

LateralEnergy lateral_energy(const Recycled<double>& at, const LateralSprings& s, const LateralSide& side,
                             const Recycled<double>& u) {
    LateralEnergy out;
    out.gradient.assign(at.size(), 0);
    const auto v = [&](std::size_t i) { return u[i] / taper(s, i); };
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double w = tributary(at, i), over = std::max(0.0, u[i] - side.clear[i]);
        out.value += w * (0.5 * s.stretch * (u[i] * u[i] + s.wall * over * over) - side.push[i] * u[i]);
        out.gradient[i] += w * (s.stretch * (u[i] + s.wall * over) - side.push[i]);
        const double inner = i > 0 ? v(i - 1) : 0, r = taper(s, i);
        if (i > 0) {
            const double pull = slope_spring(at, s, i) * (v(i) - inner);
            out.value += 0.5 * pull * (v(i) - inner);
            out.gradient[i - 1] -= pull / taper(s, i - 1);
            out.gradient[i] += pull / r;
        }
        if (i + 1 == at.size()) continue;
        const Curvature c = curvature(at, i);
        const double turn = c.in * inner + c.own * v(i) + c.out * v(i + 1);
        const double force = bend_spring(s, i, c) * r * r * turn;
        out.value += 0.5 * force * turn;
        if (i > 0) out.gradient[i - 1] += force * c.in / taper(s, i - 1);
        out.gradient[i] += force * c.own / r;
        out.gradient[i + 1] += force * c.out / taper(s, i + 1);
    }
    out.gradient[0] = 0;
    return out;
}

double stored_at_rest(const Recycled<double>& at, const LateralSprings& s, const LateralSide& side,
                      const Recycled<double>& u) {
    double sum = 0;
    for (std::size_t i = 1; i < at.size(); ++i) {
        double twice = side.push[i] * u[i];
        if (u[i] > side.clear[i]) twice -= s.wall * s.stretch * (u[i] - side.clear[i]) * side.clear[i];
        sum += 0.5 * tributary(at, i) * twice;
    }
    return sum;
}

LateralShift drag_lateral(const Recycled<double>& at, const LateralSprings& s, const LateralFriction& friction) {
    return drag_lateral(lateral_row(at, s), friction);
}

LateralShift drag_lateral(const LateralRow& row, const LateralFriction& friction) {
    const std::size_t count = row.band.size();
    LateralShift out;
    out.shift = friction.stuck;
    out.shift[0] = 0;
    if (std::all_of(out.shift.begin(), out.shift.end(), [](double d) { return d == 0; })) return out;
    Recycled<signed char>& slips = out.slips;
    slips = friction.slips;
    slips.resize(count, 0);
    Recycled<double> stuck(count), most(count), v(count);
    for (std::size_t i = 1; i < count; ++i) {
        v[i] = stuck[i] = out.shift[i] / row.taper[i];
        most[i] = row.weight[i] * friction.most[i] * row.taper[i];
    }
    // Of both sides, in v = δ over the taper.
    const auto force = [&](std::size_t i) {
        double f = 0;
        for (std::size_t d = 0; d <= std::min<std::size_t>(i, 2); ++d) f += row.band[i][d] * v[i - d];
        for (std::size_t d = 1; d <= 2 && i + d < count; ++d) f += row.band[i + d][d] * v[i + d];
        return 2 * f;
    };
    Band m;
    const auto solve = [&] {
        constexpr double kHeld = 1e8;
        m = row.band;
        v[0] = 0;
        for (std::size_t i = 1; i < count; ++i) {
            v[i] = 0.5 * slips[i] * most[i];
            if (slips[i] != 0) continue;
            v[i] = kHeld * m[i][0] * stuck[i];
            m[i][0] *= 1 + kHeld;
        }
        solve_band(m, v);
    };
    if (std::any_of(slips.begin(), slips.end(), [](signed char c) { return c != 0; })) solve();
    for (int pass = 0; pass < kDragPasses; ++pass) {
        bool same = true;
        for (std::size_t i = 1; i < count; ++i) {
            signed char now = slips[i];
            if (now == 0) {
                const double f = force(i);
                if (std::abs(f) > most[i]) now = f > 0 ? 1 : -1;
            } else if (now * (v[i] - stuck[i]) > 0) {
                now = 0;  // no further than it is carried
            }
            same = same && now == slips[i];
            slips[i] = now;
        }
        if (same) break;
        solve();
    }
    for (std::size_t i = 1; i < count; ++i) out.stored += 0.5 * force(i) * v[i];
    for (std::size_t i = 1; i < count; ++i) out.shift[i] = v[i] * row.taper[i];
    return out;
}

double half_width(double r, double u, double most) {
    if (r <= 0) return 0;
    const double v = u / r, room = v > 0 ? most - 1 : 0.6;
    return r * (1 + (room > 0 ? room * std::tanh(v / room) : 0));
}

double side_of_width(double r, double width, double most) {
    if (r <= 0) return 0;
    const double v = width / r - 1, room = v > 0 ? most - 1 : 0.6;
    return room > 0 ? r * room * std::atanh(std::clamp(v / room, -0.999, 0.999)) : 0;
}

}  // namespace tuft::brush
