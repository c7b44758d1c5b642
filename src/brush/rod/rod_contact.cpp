#include <algorithm>
#include <cmath>

#include "brush/rod/rod_edge.h"
#include "brush/rod/rod_energy.h"
#include "brush/rod/rod_law.h"
#include "brush/rod/rod_points.h"
#include "core/simd.h"

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
EndOn end_on(const NormalLaw& law, double weight, double radius, double depth, double c, double compliance) {
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
    const Distance d = crease.convex ? edge_distance(crease.edge, x) : corner_distance(crease.edge.wedge, edge, x);
    out.z += crease.share * (d.z - out.z);
    out.slope += crease.share * (d.slope - out.slope);
    out.bend = crease.share * d.bend;
    out.across = d.across;
    return out;
}

bool is_clear(const Frozen& frozen, int k, const Evaluation& at) {
    const Law& law = *frozen.law;
    const ContactPoints& points = frozen.points;
    const int per = law.points_per_segment, n = frozen.rod->segments();
    if (per < 3 || law.normal.hard) return false;
    const PointRange range = points_of(k, per, n);
    double reach = 0;
    for (int p = range.begin; p < range.end; ++p) {
        if (points.crease[p].share > 0) return false;
        reach = std::max(reach, points.obstacles[p].radius);
    }
    reach = 1.5 * (reach + law.adhesion.range);
    // The hair lies between its nodes, and a point's plane between its neighbours' planes, which are of one
    // surface here.
    const Stencil& stencil = points.stencil[range.begin];
    for (const int p : {range.begin, std::clamp(per * k, range.begin, range.end - 1), range.end - 1}) {
        const Obstacle& o = points.obstacles[p];
        for (int i = stencil.first; i < stencil.first + stencil.count; ++i) {
            if (glm::dot(at.node[i] - o.origin, o.normal) < reach) return false;
        }
    }
    return true;
}

namespace {

TUFT_CLONES double add_point(const Frozen& frozen, int p, bool derivatives, Evaluation& out) {
    const Law& law = *frozen.law;
    const ContactPoints& points = frozen.points;
    const Stencil& at = points.stencil[p];
    const Vec3 x = at.at(out.node);
    Vec3 slope{0};
    Sym3 curvature;
    double energy = 0;
    if (over_edge(frozen, p)) {
        if (is_clear_of_edge(frozen, p, x)) return 0;
        energy = add_hair_at_edge(frozen, p, derivatives, out);
        out.contact += energy;
        add_friction(points.friction[p], points.friction[p].normal, x, energy, slope, curvature);
        if (derivatives) add_potential(at, slope, curvature, out);
        return energy;
    }
    const Obstacle& o = points.obstacles[p];
    const Distance at_surface = distance_of(o, points.crease[p], law.edge, x);
    const double depth = o.radius - at_surface.z;
    if (depth <= -law.adhesion.range && !law.normal.hard) return 0;
    const Vec3& n = at_surface.slope;
    const double c = glm::dot(at.inwards(out.node), n);
    EndOn f;
    if (depth > 0 && c > 0 && points.compliance[p] > 0 && points.crease[p].share <= 0) {
        f = end_on(law.normal, points.weight[p], o.radius, depth, c, points.compliance[p]);
    } else {
        const NormalForce whole = normal_force(law.normal, points.weight[p], o.radius, depth, points.multiplier[p]);
        f = {.energy = whole.energy, .d = whole.force, .dd = whole.stiffness};
    }
    const NormalForce pull = adhesion(law.adhesion, points.weight[p], -depth);
    energy = f.energy + pull.energy;
    out.contact += energy;
    slope = (pull.force - f.d) * n;
    curvature = (f.dd + pull.stiffness) * outer(n);
    if (at_surface.bend != 0) {
        curvature += (pull.force - f.d) * at_surface.bend * outer(at_surface.across);
    }
    add_friction(points.friction[p], points.friction[p].normal, x, energy, slope, curvature);
    if (!derivatives) return energy;
    out.normal[p] = f.d;
    add_potential(at, slope, curvature, out);
    if (f.c != 0) {
        add_slope(at, at.d, f.c * n, out);
        add_curvature(at, outer(n), out, [&](int k, int l) {
            return f.cc * at.d[k] * at.d[l] - f.dc * (at.w[k] * at.d[l] + at.d[k] * at.w[l]);
        });
    }
    return energy;
}

}  // namespace

double add_contact(const Frozen& frozen, int p, bool derivatives, Evaluation& out) {
    return add_point(frozen, p, derivatives, out);
}

Obstacle met_by(const Frozen& frozen, int p, const Recycled<Vec3>& node) {
    const ContactPoints& points = frozen.points;
    const Obstacle& o = points.obstacles[p];
    if (points.crease[p].share <= 0) return {o.origin, o.normal, o.radius};
    const Vec3 x = points.stencil[p].at(node);
    const Distance d = distance_of(o, points.crease[p], frozen.law->edge, x);
    const double size = glm::length(d.slope);
    const Vec3 n = size > 1e-6 ? d.slope / size : o.normal;
    const Obstacle here{x - d.z * n, n, o.radius};
    return over_edge(frozen, p) ? mean_plane_at_edge(frozen, p, node, here) : here;
}

}  // namespace tuft::brush::rod
