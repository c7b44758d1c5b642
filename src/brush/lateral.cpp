#include "brush/lateral.h"

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
std::vector<Curvature> curvatures(const std::vector<double>& at) {
    const std::size_t n = at.size() - 1;
    std::vector<Curvature> out(n + 1);
    const double first = at[1] - at[0];
    out[0] = {0, -2 / (first * first), 2 / (first * first), 0.5 * first};
    for (std::size_t i = 1; i < n; ++i) {
        const double a = at[i] - at[i - 1], b = at[i + 1] - at[i];
        out[i] = {2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b)), 0.5 * (a + b)};
    }
    return out;
}

double tributary(const std::vector<double>& at, std::size_t i) {
    const std::size_t n = at.size() - 1;
    return 0.5 * (at[std::min(i + 1, n)] - at[i > 0 ? i - 1 : 0]);
}

/// Taper of a node over that at the root.
double taper(const LateralSprings& s, std::size_t i) { return s.taper.empty() ? 1 : s.taper[i] / s.taper[0]; }

/// λ at a node.
double reach(const LateralSprings& s, std::size_t i) { return s.reach * std::sqrt(taper(s, i)); }

/// 2 κ0 λ² r² / h of the slope spring between nodes i - 1 and i.
double slope_spring(const std::vector<double>& at, const LateralSprings& s, std::size_t i) {
    const double a = taper(s, i - 1), b = taper(s, i);
    const double from = a * reach(s, i - 1), to = b * reach(s, i);
    return s.bend * (from * from + to * to) / (at[i] - at[i - 1]);
}

/// Lower band of a symmetric matrix: [i][d] is the element (i, i - d).
using Band = std::vector<std::array<double, 3>>;

/// Solves in place by Cholesky; the matrix is positive definite.
void solve_band(Band& m, std::vector<double>& x) {
    const std::size_t n = m.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t d = std::min<std::size_t>(i, 2) + 1; d-- > 0;) {
            const std::size_t j = i - d;
            double sum = m[i][d];
            for (std::size_t k = i >= 2 ? i - 2 : 0; k < j; ++k) {
                if (j - k <= 2) sum -= m[i][i - k] * m[j][j - k];
            }
            m[i][d] = d == 0 ? std::sqrt(sum) : sum / m[j][0];
        }
        for (std::size_t d = 1; d <= std::min<std::size_t>(i, 2); ++d) x[i] -= m[i][d] * x[i - d];
        x[i] /= m[i][0];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t d = 1; d <= 2 && i + d < n; ++d) x[i] -= m[i + d][d] * x[i + d];
        x[i] /= m[i][0];
    }
}

/// Stretch and bend springs of v = u over the taper; the root's row holds it at 0.
Band spring_band(const std::vector<double>& at, const LateralSprings& s) {
    Band m(at.size(), {0, 0, 0});
    const std::vector<Curvature> c = curvatures(at);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double r = taper(s, i);
        m[i][0] += s.stretch * tributary(at, i) * r * r;
        if (i > 0) {
            const double slope = slope_spring(at, s, i);
            m[i - 1][0] += slope;
            m[i][0] += slope;
            m[i][1] -= slope;
        }
        const double k = s.bend * std::pow(reach(s, i), 4) * c[i].weight * r * r;
        m[i][0] += k * c[i].own * c[i].own;
        if (i + 1 == at.size()) continue;
        m[i + 1][0] += k * c[i].out * c[i].out;
        m[i + 1][1] += k * c[i].out * c[i].own;
        if (i == 0) continue;
        m[i - 1][0] += k * c[i].in * c[i].in;
        m[i][1] += k * c[i].in * c[i].own;
        m[i + 1][2] += k * c[i].in * c[i].out;
    }
    m[0] = {1, 0, 0};
    m[1][1] = 0;
    if (m.size() > 2) m[2][2] = 0;
    return m;
}

}  // namespace

std::vector<double> solve_lateral(const std::vector<double>& at, const LateralSprings& s,
                                  const LateralSide& side) {
    const std::size_t count = at.size();
    const Band free = spring_band(at, s);
    std::vector<char> held(count, 0);
    std::vector<double> u(count);
    for (int pass = 0; pass < kWallPasses; ++pass) {
        Band m = free;
        u[0] = 0;
        for (std::size_t i = 1; i < count; ++i) {
            const double w = tributary(at, i), r = taper(s, i);
            u[i] = w * side.push[i] * r;
            if (!held[i]) continue;
            m[i][0] += s.wall * s.stretch * w * r * r;
            u[i] += s.wall * s.stretch * w * side.clear[i] * r;
        }
        solve_band(m, u);
        bool same = true;
        for (std::size_t i = 1; i < count; ++i) {
            u[i] *= taper(s, i);
            const char now = u[i] > side.clear[i];
            same = same && now == held[i];
            held[i] = now;
        }
        if (same) break;
    }
    return u;
}

LateralEnergy lateral_energy(const std::vector<double>& at, const LateralSprings& s,
                             const LateralSide& side, const std::vector<double>& u) {
    LateralEnergy out;
    out.gradient.assign(at.size(), 0);
    const std::vector<Curvature> c = curvatures(at);
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
        const double turn = c[i].in * inner + c[i].own * v(i) + c[i].out * v(i + 1);
        const double force = s.bend * std::pow(reach(s, i), 4) * c[i].weight * r * r * turn;
        out.value += 0.5 * force * turn;
        if (i > 0) out.gradient[i - 1] += force * c[i].in / taper(s, i - 1);
        out.gradient[i] += force * c[i].own / r;
        out.gradient[i + 1] += force * c[i].out / taper(s, i + 1);
    }
    out.gradient[0] = 0;
    return out;
}

double stored_at_rest(const std::vector<double>& at, const LateralSprings& s, const LateralSide& side,
                      const std::vector<double>& u) {
    double sum = 0;
    for (std::size_t i = 1; i < at.size(); ++i) {
        double twice = side.push[i] * u[i];
        if (u[i] > side.clear[i]) twice -= s.wall * s.stretch * (u[i] - side.clear[i]) * side.clear[i];
        sum += 0.5 * tributary(at, i) * twice;
    }
    return sum;
}

LateralShift drag_lateral(const std::vector<double>& at, const LateralSprings& s, const LateralFriction& friction) {
    const std::size_t count = at.size();
    LateralShift out;
    out.shift = friction.stuck;
    out.shift[0] = 0;
    bool still = true;
    for (const double d : out.shift) still = still && d == 0;
    if (still) return out;
    // Of both sides, in v = δ over the taper.
    Band both = spring_band(at, s);
    for (std::size_t i = 1; i < count; ++i)
        for (double& k : both[i]) k *= 2;
    const auto force = [&](const std::vector<double>& v, std::size_t i) {
        double f = 0;
        for (std::size_t d = 0; d <= std::min<std::size_t>(i, 2); ++d) f += both[i][d] * v[i - d];
        for (std::size_t d = 1; d <= 2 && i + d < count; ++d) f += both[i + d][d] * v[i + d];
        return f;
    };
    std::vector<double> stuck(count), v(count);
    for (std::size_t i = 0; i < count; ++i) v[i] = stuck[i] = out.shift[i] / taper(s, i);
    std::vector<int> slips(count, 0);  // 0: sticks; else the sign of the force of the surface
    for (int pass = 0; pass < kDragPasses; ++pass) {
        bool same = true;
        for (std::size_t i = 1; i < count; ++i) {
            const double most = tributary(at, i) * friction.most[i] * taper(s, i);
            int now = slips[i];
            if (now == 0) {
                const double f = force(v, i);
                if (std::abs(f) > most) now = f > 0 ? 1 : -1;
            } else if (now * (v[i] - stuck[i]) > 0) {
                now = 0;  // no further than it is carried
            }
            same = same && now == slips[i];
            slips[i] = now;
        }
        if (same) break;
        Band m = both;
        v[0] = 0;
        for (std::size_t i = 1; i < count; ++i) {
            constexpr double kHeld = 1e8;
            v[i] = slips[i] * tributary(at, i) * friction.most[i] * taper(s, i);
            if (slips[i] != 0) continue;
            v[i] = kHeld * m[i][0] * stuck[i];
            m[i][0] *= 1 + kHeld;
        }
        solve_band(m, v);
    }
    for (std::size_t i = 1; i < count; ++i) out.stored += 0.5 * force(v, i) * v[i];
    for (std::size_t i = 1; i < count; ++i) out.shift[i] = v[i] * taper(s, i);
    return out;
}

double half_width(double r, double u, double most) {
    if (r <= 0) return 0;
    const double v = u / r, room = v > 0 ? most - 1 : 0.6;
    return r * (1 + (room > 0 ? room * std::tanh(v / room) : 0));
}

}  // namespace tuft::brush
