#include <algorithm>
#include <cmath>

#include "brush/rod/rod_energy.h"
#include "brush/rod/rod_law.h"
#include "brush/rod/rod_points.h"

namespace tuft::brush::rod {

namespace {

/// Displacement in a metric G.
struct MetricLength {
    double q = 0;  ///< √(d·G d)
    Vec3 gd{0};    ///< G d
    Sym3 g;        ///< G
};

/// Potential with its derivatives over a point's position.
struct PointPotential {
    double& energy;
    Vec3& slope;
    Sym3& curvature;
};

/// Adds a spring of stiffness k that slips at `cap`.
void add_slider(double cap, double k, const MetricLength& d, const PointPotential& to) {
    if (d.q * k <= cap) {
        to.energy += 0.5 * k * d.q * d.q;
        to.slope += k * d.gd;
        to.curvature += k * d.g;
    } else {
        to.energy += cap * (d.q - 0.5 * cap / k);
        to.slope += cap / d.q * d.gd;
        to.curvature += cap / d.q * (d.g + -1 / (d.q * d.q) * outer(d.gd));
    }
}

void add_friction(const Friction& f, const Vec3& normal, const Vec3& x, double& energy, Vec3& slope, Sym3& curvature) {
    if (f.cap <= 0 || f.stick <= 0) return;
    Vec3 d = x - f.anchor;
    d -= glm::dot(d, normal) * normal;
    const double a2 = f.across * f.across, l2 = f.along * f.along;
    const Sym3 g = a2 * (Sym3{1, 0, 0, 1, 0, 1} + -1.0 * outer(normal)) + (l2 - a2) * outer(f.grain);
    const Vec3 gd = g * d;
    const PointPotential to{energy, slope, curvature};
    add_slider(f.cap, f.stick, {std::sqrt(std::max(0.0, glm::dot(d, gd))), gd, g}, to);
    const double pushed = glm::dot(d, f.grain);
    if (f.pore_cap > 0 && pushed > 0) {
        add_slider(f.pore_cap, f.stick, {pushed, pushed * f.grain, outer(f.grain)}, to);
    }
}

/// Potential of a point by its indentation and by c = -t·n, with derivatives.
struct EndOn {
    double energy = 0, d = 0, c = 0;  ///< value, ∂/∂depth (the normal force), ∂/∂c
    double dd = 0, dc = 0, cc = 0;
};

/// min_s s²/(2 compliance) + contact(depth - c s). With e the indentation left, s = compliance c f(e) and
/// e + compliance c² f(e) = depth, whose left side is convex and grows with e: Newton from above.
EndOn end_on(const Law& law, double weight, double radius, double depth, double c, double compliance) {
    const double soft = compliance * c * c;
    double e = depth;
    NormalForce f = normal_force(law, weight, radius, e, 0);
    for (int i = 0; i < 40; ++i) {
        const double miss = e + soft * f.force - depth;
        if (miss <= 1e-15 * depth) break;
        e -= miss / (1 + soft * f.stiffness);
        f = normal_force(law, weight, radius, e, 0);
    }
    const double s = compliance * c * f.force, k = f.stiffness, total = 1 + soft * k;
    const double s_c = compliance * (f.force - c * k * s) / total;
    EndOn out;
    out.energy = f.energy + 0.5 * s * c * f.force;
    out.d = f.force;
    out.c = -s * f.force;
    out.dd = k / total;
    out.dc = -k * (s + c * s_c);
    out.cc = -s_c * f.force - s * out.dc;
    return out;
}

}  // namespace

Distance distance_of(const Obstacle& o, const Crease& crease, double edge, const Vec3& x) {
    Distance out{glm::dot(x - o.origin, o.normal), o.normal};
    if (crease.share <= 0) return out;
    const Distance d = crease.convex ? edge_distance(crease.wedge, edge, x) : corner_distance(crease.wedge, edge, x);
    out.z += crease.share * (d.z - out.z);
    out.slope += crease.share * (d.slope - out.slope);
    out.bend = crease.share * d.bend;
    out.across = d.across;
    return out;
}

bool all_clear(const Frozen& frozen, int k, const Evaluation& at) {
    const Law& law = *frozen.law;
    const int per = law.points_per_segment, n = frozen.rod->segments();
    if (per < 3 || law.hard) return false;
    const PointRange range = points_of(k, per, n);
    double reach = 0;
    for (int p = range.begin; p < range.end; ++p) {
        if (frozen.crease[p].share > 0) return false;
        reach = std::max(reach, frozen.obstacles[p].radius);
    }
    reach = 1.5 * (reach + law.adhesion_range);
    // The hair lies between its nodes, and a point's plane between its neighbours' planes, which are of one
    // surface here.
    const Stencil& stencil = frozen.stencil[range.begin];
    for (const int p : {range.begin, std::clamp(per * k, range.begin, range.end - 1), range.end - 1}) {
        const Obstacle& o = frozen.obstacles[p];
        for (int i = stencil.first; i < stencil.first + stencil.count; ++i) {
            if (glm::dot(at.node[i] - o.origin, o.normal) < reach) return false;
        }
    }
    return true;
}

namespace {

/// Adds curvature · f(k, l) to the second derivatives over nodes k and l of a stencil.
template <class F>
void add_curvature(const Stencil& at, const Sym3& curvature, Evaluation& out, const F& f) {
    for (int k = 0; k < at.count; ++k) out.curvature[at.first + k] += f(k, k) * curvature;
    for (int k = 0; k + 1 < at.count; ++k) out.coupling[at.first + k] += f(k, k + 1) * curvature;
    if (at.count > 2) out.across[at.first] += f(0, 2) * curvature;
}

void add_slope(const Stencil& at, const double* w, const Vec3& slope, Evaluation& out) {
    for (int k = 0; k < at.count; ++k) out.slope[at.first + k] += w[k] * slope;
}

/// Part of a contact point's length of hair over a crease.
struct Piece {
    Stencil at;
    double weight = 0, radius = 0, compliance = 0;
};

/// A piece of hair at a crease.
struct HairAtCrease {
    const Law& law;
    const Crease& crease;
    const Obstacle& obstacle;
    const Piece& piece;
    Vec3 x{0};        ///< where it is
    Vec3 inwards{0};  ///< unit, its direction to the root
};

/// Hair over a crease, shortened along itself by `s`.
struct Shortened {
    double s = 0;
    Vec3 x{0};
    Distance at_surface;
    NormalForce push, pull;  // of the contact and of the film
    double miss = 0;         // s / compliance less the force along the hair
};

Shortened shortened_by(const HairAtCrease& hair, double s) {
    const auto& [law, crease, obstacle, piece, x, inwards] = hair;
    Shortened out{.s = s, .x = x + s * inwards};
    out.at_surface = distance_of(obstacle, crease, law.edge, out.x);
    const double depth = piece.radius - out.at_surface.z;
    out.push = normal_force(law, piece.weight, piece.radius, depth, 0);
    out.pull = adhesion(law, piece.weight, -depth);
    if (piece.compliance > 0) {
        const double force = out.push.force - out.pull.force;
        out.miss = s / piece.compliance - force * glm::dot(inwards, out.at_surface.slope);
    }
    return out;
}

/// The largest s at which s²/(2 compliance) + contact(r - z(x + s i)) is stationary: where the hair, coming
/// from its root, meets the surface. Bracketed from outside, then false position (Illinois).
Shortened shorten_to_surface(const HairAtCrease& hair) {
    const auto at = [&](double s) { return shortened_by(hair, s); };
    Shortened low = at(0);
    if (hair.piece.compliance <= 0 || low.push.force <= 0) return low;
    constexpr int kSteps = 12;
    const double step = 3 * hair.law.end_compliance / kSteps;
    Shortened high = at(kSteps * step);
    if (high.miss <= 0) return high;
    // A step brings hair no nearer to the surface than it is long: as far as neither contact nor film can begin, no
    // sign changes.
    const double off = high.at_surface.z - hair.piece.radius - hair.law.adhesion_range - 1e-9;
    const int clear = std::clamp(static_cast<int>(off / step), 0, kSteps - 1);
    if (clear > 0) high = at((kSteps - clear) * step);
    for (int k = kSteps - clear; k-- > 0;) {
        low = at(k * step);
        if (low.miss <= 0) break;
        high = low;
    }
    if (low.miss >= 0) return low;
    double at_low = low.miss, at_high = high.miss;
    Shortened mid = low;
    for (int i = 0; i < 60 && high.s - low.s > 1e-15; ++i) {
        mid = at((low.s * at_high - high.s * at_low) / (at_high - at_low));
        if (std::abs(mid.miss) < 1e-12 * (1 + mid.push.force)) break;
        if (mid.miss > 0) {
            high = mid;
            at_high = mid.miss;
            at_low *= 0.5;
        } else {
            low = mid;
            at_low = mid.miss;
            at_high *= 0.5;
        }
    }
    return mid;
}

/// Adds the potential of a piece over an edge where it stands. With i the direction inwards, y = x + s i
/// and ψ(y) the contact's: E = s²/(2 compliance) + ψ, E_x = ψ', E_i = s ψ'.
double add_piece(int p, const Piece& piece, const Shortened& st, Evaluation& out) {
    const Stencil& at = piece.at;
    const Vec3 inwards = at.inwards(out.node);
    const double force = st.push.force - st.pull.force;
    if (force == 0) return 0;
    const Vec3& n = st.at_surface.slope;
    const Vec3 slope = -force * n;
    Sym3 xx = (st.push.stiffness + st.pull.stiffness) * outer(n);
    xx += -force * st.at_surface.bend * outer(st.at_surface.across);
    out.normal[p] += st.push.force;
    double energy = st.push.energy + st.pull.energy;
    if (st.s > 0) {
        energy += st.s * st.s / (2 * piece.compliance);
        const Vec3 ci = xx * inwards, b = slope + st.s * ci;
        const double total = std::max(1 / piece.compliance + glm::dot(inwards, ci), 0.01 / piece.compliance);
        const Sym3 ii = st.s * st.s * xx + -1 / total * outer(b);
        const Sym3 mixed = 2 * st.s * xx + -2 / total * symmetric(ci, b);
        xx += -1 / total * outer(ci);
        add_slope(at, at.d, st.s * slope, out);
        add_curvature(at, mixed, out, [&](int k, int l) { return 0.5 * (at.w[k] * at.d[l] + at.d[k] * at.w[l]); });
        add_curvature(at, ii, out, [&](int k, int l) { return at.d[k] * at.d[l]; });
    }
    add_slope(at, at.w, slope, out);
    add_curvature(at, xx, out, [&](int k, int l) { return at.w[k] * at.w[l]; });
    return energy;
}

bool over_edge(const Frozen& frozen, int p) {
    return frozen.crease[p].share > 0 && frozen.crease[p].convex && !frozen.law->hard;
}

/// An edge presses on little more than a point of the hair, which passes from contact point to
/// contact point as the hair moves over it: there the length of each is taken in pieces.
constexpr int kPieces = 4;

/// Calls f(piece, its hair shortened to the surface) for the pieces of contact point p.
template <class F>
void for_clusters(const Frozen& frozen, int p, const Recycled<Vec3>& node, const F& f) {
    const int per = frozen.law->points_per_segment, n = frozen.rod->segments();
    for (int k = 0; k < kPieces; ++k) {
        const double offset = (k + 0.5) / kPieces - 0.5;
        const int first = offset < 0 ? p - 1 : p;
        if (first < 0 || first >= per * n) continue;
        Piece piece;
        const int j = first / per;
        piece.at = stencil_at(*frozen.rod, rounded(*frozen.law), j, (p + offset) / per - j);
        piece.weight = frozen.rod->length[j] / (per * kPieces);
        const Obstacle &o = frozen.obstacles[p], &other = frozen.obstacles[offset < 0 ? p - 1 : p + 1];
        piece.radius = o.radius + std::abs(offset) * (other.radius - o.radius);
        piece.compliance = frozen.compliance[p] * frozen.weight[p] / piece.weight;
        f(piece,
          shorten_to_surface({*frozen.law, frozen.crease[p], o, piece, piece.at.at(node), piece.at.inwards(node)}));
    }
}

}  // namespace

double add_contact(const Frozen& frozen, int p, Evaluation& out) {
    const Law& law = *frozen.law;
    const Obstacle& o = frozen.obstacles[p];
    const Stencil& at = frozen.stencil[p];
    const Vec3 x = at.at(out.node);
    const Distance at_surface = distance_of(o, frozen.crease[p], law.edge, x);
    const double depth = o.radius - at_surface.z;
    const double length = frozen.rod->length[frozen.place[p].node] / law.points_per_segment;
    const double reach = law.adhesion_range + (over_edge(frozen, p) ? length : 0);
    if (depth <= -reach && !law.hard) return 0;
    const Vec3& n = at_surface.slope;
    const auto add = [&](const Vec3& slope, const Sym3& curvature) {
        add_slope(at, at.w, slope, out);
        add_curvature(at, curvature, out, [&](int k, int l) { return at.w[k] * at.w[l]; });
    };
    if (over_edge(frozen, p)) {
        double energy = 0;
        for_clusters(frozen, p, out.node, [&](const Piece& piece, const Shortened& standing) {
            energy += add_piece(p, piece, standing, out);
        });
        out.contact += energy;
        Vec3 slope{0};
        Sym3 curvature;
        add_friction(frozen.friction[p], frozen.friction[p].normal, x, energy, slope, curvature);
        add(slope, curvature);
        return energy;
    }
    const double c = glm::dot(at.inwards(out.node), n);
    EndOn f;
    if (depth > 0 && c > 0 && frozen.compliance[p] > 0 && frozen.crease[p].share <= 0) {
        f = end_on(law, frozen.weight[p], o.radius, depth, c, frozen.compliance[p]);
    } else {
        const NormalForce whole = normal_force(law, frozen.weight[p], o.radius, depth, frozen.multiplier[p]);
        f = {.energy = whole.energy, .d = whole.force, .dd = whole.stiffness};
    }
    const NormalForce pull = adhesion(law, frozen.weight[p], -depth);
    double energy = f.energy + pull.energy;
    out.contact += energy;
    out.normal[p] = f.d;
    Vec3 slope = (pull.force - f.d) * n;
    Sym3 curvature = (f.dd + pull.stiffness) * outer(n);
    if (at_surface.bend != 0) {
        curvature += (pull.force - f.d) * at_surface.bend * outer(at_surface.across);
    }
    add_friction(frozen.friction[p], frozen.friction[p].normal, x, energy, slope, curvature);
    add(slope, curvature);
    if (f.c != 0) {
        add_slope(at, at.d, f.c * n, out);
        add_curvature(at, outer(n), out, [&](int k, int l) {
            return f.cc * at.d[k] * at.d[l] - f.dc * (at.w[k] * at.d[l] + at.d[k] * at.w[l]);
        });
    }
    return energy;
}

Obstacle met_by(const Frozen& frozen, int p, const Recycled<Vec3>& node) {
    const Obstacle& o = frozen.obstacles[p];
    if (frozen.crease[p].share <= 0) return {o.origin, o.normal, o.radius};
    const Vec3 x = frozen.stencil[p].at(node);
    const Distance d = distance_of(o, frozen.crease[p], frozen.law->edge, x);
    const double size = glm::length(d.slope);
    const Vec3 n = size > 1e-6 ? d.slope / size : o.normal;
    const Obstacle here{x - d.z * n, n, o.radius};
    if (!over_edge(frozen, p)) return here;
    // The mean over its pieces, by their forces.
    double total = 0;
    Vec3 normal{0}, origin{0};
    for_clusters(frozen, p, node, [&](const Piece&, const Shortened& st) {
        total += st.push.force;
        normal += st.push.force * st.at_surface.slope;
        origin += st.push.force * (st.x - st.at_surface.z * st.at_surface.slope);
    });
    const double mean = glm::length(normal);
    return mean > 1e-6 * total && total > 0 ? Obstacle{origin / total, normal / mean, o.radius} : here;
}

}  // namespace tuft::brush::rod
