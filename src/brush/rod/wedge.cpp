#include "brush/rod/wedge.h"

#include <algorithm>
#include <cmath>

namespace tuft::brush {

RoundedEdge round_edge(const Wedge& w, double rounding) {
    RoundedEdge out{.wedge = w, .rounding = rounding, .c = glm::dot(w.normal[0], w.normal[1])};
    const double c = out.c, apart = 1 - c * c;
    // Sharper than 90°, the ridge would lie ρ (√(2/(1+c)) - 1) under the edge.
    if (c < 0) out.rounding *= (std::sqrt(2.0) - 1) / (std::sqrt(2 / std::max(1 + c, 1e-9)) - 1);
    if (apart > 1e-9) {
        out.per_apart = 1 / apart;
        out.ridge = glm::cross(w.normal[0], w.normal[1]) / std::sqrt(apart);
    }
    return out;
}

namespace {

/// From the ridge of the planes moved in by ρ, a point lies at u n0 + v n1 across the edge. It is in front of the edge
/// where both are positive.
struct InFront {
    double u = 0, v = 0, far = 0;  // far: 0 where it is not

    InFront(const RoundedEdge& e, double z0, double z1) {
        const double in0 = z0 + e.rounding, in1 = z1 + e.rounding;
        u = (in0 - e.c * in1) * e.per_apart;
        v = (in1 - e.c * in0) * e.per_apart;
        if (u > 0 && v > 0) far = std::sqrt(u * u + v * v + 2 * e.c * u * v);
        if (far <= 1e-12) far = 0;
    }
};

}  // namespace

Distance edge_distance(const RoundedEdge& e, const Vec3& x) {
    const Wedge& w = e.wedge;
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]), z1 = glm::dot(x - w.origin[1], w.normal[1]);
    const InFront f(e, z0, z1);
    if (f.far > 0) {
        const Vec3 n = (f.u * w.normal[0] + f.v * w.normal[1]) / f.far;
        return {f.far - e.rounding, n, 1 / f.far, glm::cross(e.ridge, n)};
    }
    return z0 > z1 ? Distance{z0, w.normal[0]} : Distance{z1, w.normal[1]};
}

Distance edge_distance(const Wedge& wedge, double rounding, const Vec3& x) {
    return edge_distance(round_edge(wedge, rounding), x);
}

LineOverEdge::LineOverEdge(const RoundedEdge& edge, const Vec3& x, const Vec3& direction) : edge_(edge) {
    for (int i = 0; i < 2; ++i) {
        height_[i] = glm::dot(x - edge.wedge.origin[i], edge.wedge.normal[i]);
        climb_[i] = glm::dot(direction, edge.wedge.normal[i]);
    }
    across_ = (climb_[0] * climb_[0] + climb_[1] * climb_[1] - 2 * edge.c * climb_[0] * climb_[1]) * edge.per_apart;
}

LineDistance LineOverEdge::at(double s) const {
    const double z0 = height_[0] + s * climb_[0], z1 = height_[1] + s * climb_[1];
    const InFront f(edge_, z0, z1);
    if (f.far > 0) {
        const double slope = (f.u * climb_[0] + f.v * climb_[1]) / f.far;
        return {f.far - edge_.rounding, slope, (across_ - slope * slope) / f.far};
    }
    return z0 > z1 ? LineDistance{z0, climb_[0], 0} : LineDistance{z1, climb_[1], 0};
}

Distance corner_distance(const Wedge& w, double rounding, const Vec3& x) {
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]);
    const double z1 = glm::dot(x - w.origin[1], w.normal[1]), apart = z1 - z0;
    const double w0 = std::clamp(0.5 + 0.5 * apart / rounding, 0.0, 1.0);
    const double round = std::max(0.0, rounding - std::abs(apart));
    Distance out{(apart > 0 ? z0 : z1) - round * round / (4 * rounding), w0 * w.normal[0] + (1 - w0) * w.normal[1]};
    if (round > 0) {
        out.bend = -1 / (2 * rounding);
        out.across = w.normal[0] - w.normal[1];
    }
    return out;
}

}  // namespace tuft::brush
